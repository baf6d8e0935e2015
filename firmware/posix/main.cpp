// volcomp-node: the compensation node as a Linux process on a SocketCAN interface, or over a frame
// pipe, where time is counted in turns and every run is the same.
// Exit codes: 0 ended by SIGINT, SIGTERM or the other end of the pipe, 2 input that cannot be used,
// 3 the interface was lost and --exit-on-lost-interface was given.

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "firmware/canopen/exchange.hpp"
#include "firmware/node/node.hpp"
#include "firmware/node/store/read_only_storage.hpp"
#include "firmware/node/store/record_storage.hpp"
#include "firmware/posix/interface_check.hpp"
#include "firmware/posix/kernel_filter.hpp"
#include "firmware/posix/real_time.hpp"
#include "firmware/posix/service_manager.hpp"
#include "firmware/posix/timed_exchange.hpp"
#include "hal/linux/file_blocks.hpp"
#include "hal/linux/lasting_can.hpp"
#include "hal/linux/node_pipe.hpp"
#include "hal/linux/steady_clock.hpp"

namespace {

using volcomp::hal::CanBusState;
using volcomp::hal::FileBlocks;
using volcomp::hal::LastingCan;
using volcomp::hal::NodePipe;
using volcomp::hal::OpenStatus;
using volcomp::node::Node;
using volcomp::node::ReadOnlyStorage;
using volcomp::node::RecordStorage;
using volcomp::node::Storage;
using volcomp::node::Way;

constexpr int kUnusableInput = 2;
constexpr int kInterfaceLost = 3;
constexpr const char* kNoProof =
    "the interface does not tell when a target has been on the bus: one that is late is not "
    "noticed";

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int /*signal*/) { stop_requested = 1; }

struct Arguments {
  std::string link;
  std::string store;
  int node_id = 32;
  bool exit_on_lost_interface = false;
  volcomp::posix::RealTime real_time;
};

void say(const std::string& what, const std::string& sentence) {
  static_cast<void>(std::fprintf(stderr, "volcomp-node: %s: %s\n", what.c_str(), sentence.c_str()));
}

int complain(const std::string& what, OpenStatus status) {
  say(what, volcomp::hal::sentence(status));
  return kUnusableInput;
}

// False: the node is to end.
bool outlives(LastingCan::News news, const Arguments& arguments) {
  const bool lost = news == LastingCan::News::lost;
  const bool ends = lost && arguments.exit_on_lost_interface;
  if (lost) {
    say(arguments.link, ends ? "the interface is down or gone"
                             : "the interface is down or gone; the node waits until it is back");
  }
  if (news == LastingCan::News::back) say(arguments.link, "the interface is back");
  return !ends;
}

// Ways of axes as they are stored, and as long as nobody writes others.
void tell_setup(const Node& node, const std::string& interface) {
  const auto& ways = node.objects().way;
  const bool forwards = std::find(ways.begin(), ways.end(),
                                  static_cast<std::uint8_t>(Way::forwarded_target)) != ways.end();
  const volcomp::hal::CanInterface found = volcomp::hal::ask_link(interface.c_str());
  for (const std::string& remark : volcomp::posix::remarks(found, forwards))
    say(interface, remark);
}

int serve(Node& node, LastingCan& port, const Arguments& arguments) {
  const volcomp::hal::SteadyClock clock;
  volcomp::posix::TimedExchange<LastingCan, volcomp::hal::SteadyClock> exchange(clock);
  volcomp::posix::ServiceManager manager;
  volcomp::posix::KernelFilter filter;
  constexpr std::uint64_t kPoll_us = 1000;
  static_cast<void>(port.hear_own());  // where it is refused, nothing comes back: told below
  node.power_on(clock.now_us());
  tell_setup(node, arguments.link);
  manager.ready("node " + std::to_string(arguments.node_id) + " on " + arguments.link);
  while (stop_requested == 0) {
    node.bus_state(port.bus_state());
    if (port.bus_state() == CanBusState::off) exchange.forget_sent(node);
    exchange.turn(node, port);
    node.frames_lost(port.take_losses());
    node.controller_errors(port.take_errors());
    if (exchange.take_no_proof()) say(arguments.link, kNoProof);
    filter.follow(node, port);
    const std::uint64_t now = clock.now_us();
    const LastingCan::News news = port.supervise(now);
    // What waits for an interface that is gone must not leave when it is back.
    if (news == LastingCan::News::lost) {
      node.port_lost();
      exchange.forget_sent(node);
    }
    if (!outlives(news, arguments)) return kInterfaceLost;
    manager.alive(now);
    const std::uint64_t deadline = node.deadline_us();
    const std::uint64_t pause = deadline <= now ? 0 : std::min(deadline - now, kPoll_us);
    static_cast<void>(port.wait(static_cast<std::uint32_t>(pause)));
  }
  manager.stopping();
  return 0;
}

int serve(Node& node, NodePipe& port, const Arguments& /*arguments*/) {
  constexpr std::uint32_t kLook_us = 100'000;
  node.power_on(port.now_us());
  while (stop_requested == 0 && !port.ended()) {
    if (!port.begin_turn(kLook_us)) continue;
    volcomp::canopen::exchange(node.device(), port, port.now_us());
    port.end_turn();
  }
  return 0;
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
  return serve(node, port, arguments);
}

// nullptr where nothing is kept.
OpenStatus open_store(const std::string& path, Storage*& store) {
  static FileBlocks blocks;
  static RecordStorage<FileBlocks> storage(blocks);
  static ReadOnlyStorage kept(storage);
  store = nullptr;
  if (path.empty()) return {};
  const OpenStatus status = blocks.open(path.c_str());
  if (!status.ok()) return status;
  store = &storage;
  if (blocks.read_only()) {
    say(path, "can only be read: what is stored is used, and 1010h and 1011h are refused");
    store = &kept;
  }
  return status;
}

int run(const Arguments& arguments) {
  Storage* store = nullptr;
  if (const OpenStatus status = open_store(arguments.store, store); !status.ok())
    return complain(arguments.store, status);
  static Node node(static_cast<std::uint8_t>(arguments.node_id), store);
  static constexpr std::string_view kPipe = "pipe:";
  if (arguments.link.compare(0, kPipe.size(), kPipe) == 0) {
    static NodePipe pipe;
    return run_on(pipe, &arguments.link[kPipe.size()], arguments, node);
  }
  if (const auto failed = volcomp::posix::become_real_time(arguments.real_time)) {
    static_cast<void>(std::fprintf(stderr, "volcomp-node: %s\n", failed->c_str()));
    return kUnusableInput;
  }
  if (arguments.real_time.priority == 0)
    say(arguments.link,
        "an ordinary priority: other work on this computer delays offsets (--priority)");
  static LastingCan can;
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
                 "is kept; one that can only be read is used and not changed)");
  app.add_flag("--exit-on-lost-interface", arguments.exit_on_lost_interface,
               "End with exit code 3 when the CAN interface goes down or away; without it the node "
               "waits until the interface is back");
  app.add_option("--priority", arguments.real_time.priority,
                 "Real-time priority (SCHED_FIFO), with the memory locked; below that of the "
                 "interrupt threads of the CAN controller (default: none)")
      ->check(CLI::Range(1, 99));
  app.add_option("--cpu", arguments.real_time.cpu, "Stay on this processor, from 0 (default: any)")
      ->check(CLI::Range(0, 1023));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : kUnusableInput;
  }
  return run(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return start(argc, argv);
  } catch (...) {
    static_cast<void>(std::fputs("volcomp-node: the command line cannot be read\n", stderr));
    return kUnusableInput;
  }
}
