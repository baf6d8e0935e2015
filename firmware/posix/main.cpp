// volcomp-node: the compensation node as a Linux process on a SocketCAN interface.
// Exit codes: 0 ended by SIGINT or SIGTERM, 2 input that cannot be used.

#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "firmware/canopen/exchange.hpp"
#include "firmware/node/node.hpp"
#include "firmware/node/record_storage.hpp"
#include "hal/linux/file_blocks.hpp"
#include "hal/linux/socket_can.hpp"
#include "hal/linux/steady_clock.hpp"

namespace {

using volcomp::hal::FileBlocks;
using volcomp::hal::OpenStatus;
using volcomp::hal::SocketCan;
using volcomp::node::Node;
using volcomp::node::RecordStorage;

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int /*signal*/) { stop_requested = 1; }

struct Arguments {
  std::string interface;
  std::string store;
  int node_id = 32;
};

int complain(const std::string& what, OpenStatus status) {
  static_cast<void>(std::fprintf(stderr, "volcomp-node: %s: %s\n", what.c_str(),
                                 volcomp::hal::sentence(status.result)));
  return 2;
}

void serve(Node& node, SocketCan& port) {
  const volcomp::hal::SteadyClock clock;
  constexpr std::uint64_t kPoll_us = 1000;
  node.power_on(clock.now_us());
  while (stop_requested == 0) {
    volcomp::canopen::exchange(node, port, clock.now_us());
    const std::uint64_t now = clock.now_us();
    const std::uint64_t deadline = node.deadline_us();
    const std::uint64_t pause = deadline <= now ? 0 : std::min(deadline - now, kPoll_us);
    static_cast<void>(port.wait(static_cast<std::uint32_t>(pause)));
  }
}

int run(const Arguments& arguments) {
  static FileBlocks blocks;
  static RecordStorage<FileBlocks> storage(blocks);
  if (!arguments.store.empty()) {
    const OpenStatus status = blocks.open(arguments.store.c_str());
    if (!status.ok()) return complain(arguments.store, status);
  }
  static SocketCan port;
  const OpenStatus status = port.open(arguments.interface.c_str());
  if (!status.ok()) return complain(arguments.interface, status);

  static Node node(static_cast<std::uint8_t>(arguments.node_id),
                   arguments.store.empty() ? nullptr : &storage);
  static_cast<void>(std::signal(SIGINT, request_stop));
  static_cast<void>(std::signal(SIGTERM, request_stop));
  std::printf("volcomp-node: node %d on %s\n", arguments.node_id, arguments.interface.c_str());
  static_cast<void>(std::fflush(stdout));
  serve(node, port);
  return 0;
}

int start(int argc, char** argv) {
  CLI::App app{"The volcomp compensation node on a CAN interface. Ends with SIGINT or SIGTERM."};
  app.name("volcomp-node");
  app.set_version_flag("--version", std::string("volcomp-node ") + VOLCOMP_NODE_VERSION);
  Arguments arguments;
  app.add_option("--can", arguments.interface, "SocketCAN interface, for instance can0")
      ->required();
  app.add_option("--node-id", arguments.node_id, "CANopen node id")
      ->check(CLI::Range(1, 127))
      ->capture_default_str();
  app.add_option("--store", arguments.store,
                 "File that keeps parameters and tables (made when missing; without it nothing "
                 "is kept)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  return run(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return start(argc, argv);
  } catch (...) {
    static_cast<void>(std::fputs("volcomp-node: the command line cannot be read\n", stderr));
    return 2;
  }
}
