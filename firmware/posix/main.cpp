// volcomp-node: the compensation node as a Linux process on a SocketCAN interface, or over a frame
// pipe, where time is counted in turns and every run is the same.
// Exit codes: 0 ended by SIGINT, SIGTERM or the other end of the pipe, 2 input that cannot be used.

#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "firmware/canopen/exchange.hpp"
#include "firmware/node/node.hpp"
#include "firmware/node/store/record_storage.hpp"
#include "hal/linux/file_blocks.hpp"
#include "hal/linux/node_pipe.hpp"
#include "hal/linux/socket_can.hpp"
#include "hal/linux/steady_clock.hpp"

namespace {

using volcomp::hal::FileBlocks;
using volcomp::hal::NodePipe;
using volcomp::hal::OpenStatus;
using volcomp::hal::SocketCan;
using volcomp::node::Node;
using volcomp::node::RecordStorage;

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int /*signal*/) { stop_requested = 1; }

struct Arguments {
  std::string link;
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

void serve(Node& node, NodePipe& port) {
  constexpr std::uint32_t kLook_us = 100'000;
  node.power_on(port.now_us());
  while (stop_requested == 0 && !port.ended()) {
    if (!port.begin_turn(kLook_us)) continue;
    volcomp::canopen::exchange(node, port, port.now_us());
    port.end_turn();
  }
}

template <class Port>
int run_on(Port& port, const char* name, const Arguments& arguments, Node& node) {
  if (const OpenStatus status = port.open(name); !status.ok())
    return complain(arguments.link, status);
  static_cast<void>(std::signal(SIGINT, request_stop));
  static_cast<void>(std::signal(SIGTERM, request_stop));
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));  // a pipe that breaks is noticed anyway
  std::printf("volcomp-node: node %d on %s\n", arguments.node_id, arguments.link.c_str());
  static_cast<void>(std::fflush(stdout));
  serve(node, port);
  return 0;
}

int run(const Arguments& arguments) {
  static FileBlocks blocks;
  static RecordStorage<FileBlocks> storage(blocks);
  if (!arguments.store.empty()) {
    const OpenStatus status = blocks.open(arguments.store.c_str());
    if (!status.ok()) return complain(arguments.store, status);
  }
  static Node node(static_cast<std::uint8_t>(arguments.node_id),
                   arguments.store.empty() ? nullptr : &storage);
  static constexpr std::string_view kPipe = "pipe:";
  if (arguments.link.compare(0, kPipe.size(), kPipe) == 0) {
    static NodePipe pipe;
    return run_on(pipe, &arguments.link[kPipe.size()], arguments, node);
  }
  static SocketCan can;
  return run_on(can, arguments.link.c_str(), arguments, node);
}

int start(int argc, char** argv) {
  CLI::App app{"The volcomp compensation node on a CAN interface. Ends with SIGINT or SIGTERM."};
  app.name("volcomp-node");
  app.set_version_flag("--version", std::string("volcomp-node ") + VOLCOMP_NODE_VERSION);
  Arguments arguments;
  app.add_option("--can", arguments.link,
                 "SocketCAN interface, for instance can0, or pipe:FOLDER (frame pipe)")
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
