#include "host_sim/sim/boards/emulated_node.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <fstream>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "host_sim/host/bus/links/boot_up.hpp"
#include "host_sim/host/bus/links/paced_link.hpp"
#include "host_sim/host/bus/links/serial_device.hpp"
#include "host_sim/host/bus/links/socket_link.hpp"

namespace volcomp::sim {
namespace {

// Reads the progress of the processor of a running QEMU over its machine protocol (QMP).
class QemuMonitor {
 public:
  // `socket`: the Unix socket on which QEMU listens (-qmp). Throws UserError naming it, here and
  // later, when there is no answer or none of QEMU.
  explicit QemuMonitor(const std::string& socket) : socket_(socket) {
    if (!next_message().contains("QMP")) fail("no QEMU listens there");
    static_cast<void>(ask("qmp_capabilities"));
  }

  // Executed since the start. QEMU counts with -icount only. It answers in its main loop, each turn
  // of which also takes one frame out of a CAN interface: a call takes in one that waits there.
  [[nodiscard]] std::uint64_t instructions();

 private:
  [[nodiscard]] nlohmann::json ask(const char* command);
  [[nodiscard]] nlohmann::json next_message();
  [[noreturn]] void fail(const char* what) const {
    throw host::UserError(socket_.path() + ": " + what);
  }

  host::SerialDevice socket_;
  std::string incoming_;
};

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{30};
constexpr std::uint32_t kLook_us = 100'000;

std::uint64_t QemuMonitor::instructions() {
  const nlohmann::json answer = ask("query-replay");
  if (!answer.contains("icount")) fail("this QEMU does not tell how many instructions it executed");
  return answer.at("icount").get<std::uint64_t>();
}

// QEMU also sends events in between.
nlohmann::json QemuMonitor::ask(const char* command) {
  const std::string text = nlohmann::json{{"execute", command}}.dump() + "\n";
  if (socket_.write(text) != text.size()) fail("takes no more commands");
  for (;;) {
    nlohmann::json message = next_message();
    if (message.contains("return")) return message["return"];
    if (message.contains("error")) fail("refuses a command");
  }
}

nlohmann::json QemuMonitor::next_message() {
  const Clock::time_point until = Clock::now() + kPatience;
  std::size_t end = incoming_.find('\n');
  for (; end == std::string::npos; end = incoming_.find('\n')) {
    if (Clock::now() > until) fail("does not answer");
    socket_.wait(kLook_us);
    incoming_ += socket_.read();
  }
  const std::string line = incoming_.substr(0, end);
  incoming_.erase(0, end + 1);
  nlohmann::json message = nlohmann::json::parse(line, nullptr, false);
  if (!message.is_object()) fail("does not answer as QEMU does");
  return message;
}

constexpr int kEndPatience_ms = 10'000;
constexpr int kCanBootPatience_ms = 60'000;  // in an emulator inside an emulator
constexpr std::size_t kLastLines = 24;       // a whole fault report
constexpr const char* kMonitor = "monitor";
// The controller has room for five frames. After four its processor gets 10 000 instructions, 0.64
// ms of its own time, in which it may also compute a cycle; a bus of 1 Mbit/s would take half a
// millisecond for them.
constexpr int kCanBurst = 4;
constexpr std::uint64_t kInstructionsPerBurst = 10'000;

std::filesystem::path find_emulator(const EmulatedBoard& board) {
  const char* const name = board.has_can_controller ? "qemu-system-aarch64" : "qemu-system-arm";
  std::filesystem::path path = find_program(name);
  if (path.empty())
    throw host::UserError(
        fmt::format("{} is not installed (Debian: apt install qemu-system-arm)", name));
  return path;
}

std::filesystem::path find_image(const EmulatedBoard& board, const std::filesystem::path& given) {
  const std::filesystem::path image = given.empty() ? node_image(board) : given;
  if (std::filesystem::is_regular_file(image)) return std::filesystem::absolute(image);
  if (!given.empty()) throw host::UserError(fmt::format("{}: no such file", given.string()));
  throw host::UserError(fmt::format(
      "{}: there is no image; build it first: cmake --preset {} && cmake --build --preset {}",
      image.lexically_normal().string(), board.name, board.name));
}

using Words = std::vector<std::string>;

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// One instruction every 64 ns of virtual time, which does not depend on anything else.
Words command(const EmulatedBoard& board, const Words& machine, const std::string& arguments,
              const std::filesystem::path& image) {
  return Words{find_emulator(board).string()} + machine +
         Words{"-nographic",
               "-monitor",
               "none",
               "-serial",
               "stdio",
               "-icount",
               "shift=6,sleep=off",
               "-semihosting-config",
               "enable=on,target=native,arg=volcomp-node" + arguments,
               "-kernel",
               image.string()};
}

// A Kvaser card with an SJA1000 on the PCI bus, and its bus joined to the interface.
Words can_machine(const EmulatedBoard& board, const std::string& interface) {
  return {"-M",      fmt::format("{},highmem=off,gic-version=2", board.machine),
          "-cpu",    "cortex-a53",
          "-m",      "32",
          "-nic",    "none",
          "-object", "can-bus,id=can",
          "-device", "kvaser_pci,canbus=can",
          "-object", fmt::format("can-host-socketcan,id=host,canbus=can,if={}", interface),
          "-qmp",    fmt::format("unix:{},server=on,wait=off", kMonitor)};
}

// Looks after the firmware while this process waits for it.
class WatchedLink final : public host::FrameLink {
 public:
  WatchedLink(std::unique_ptr<host::FrameLink> link, std::function<void()> watch)
      : link_(std::move(link)), watch_(std::move(watch)) {}

  [[nodiscard]] bool send(const hal::CanFrame& frame) override { return link_->send(frame); }
  [[nodiscard]] bool receive(hal::CanFrame& frame) override { return link_->receive(frame); }
  void wait(std::uint32_t timeout_us) override {
    watch_();
    link_->wait(timeout_us);
  }
  [[nodiscard]] std::uint64_t now_us() const override { return link_->now_us(); }
  [[nodiscard]] bool turn_by_turn() const override { return false; }

 private:
  std::unique_ptr<host::FrameLink> link_;
  std::function<void()> watch_;
};

}  // namespace

const EmulatedBoard& emulated_board(const std::string& name) {
  for (const EmulatedBoard& board : kEmulatedBoards) {
    if (name == board.name) return board;
  }
  throw host::UserError(fmt::format("{}: there is no firmware for such a board", name));
}

std::filesystem::path node_image(const EmulatedBoard& board) {
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  const std::filesystem::path builds = self.parent_path() / "../..";
  return builds / board.name / "firmware" / fmt::format("volcomp-node-{}.elf", board.name);
}

EmulatedNode::EmulatedNode(const EmulatedBoard& board, const std::filesystem::path& image,
                           const std::string& interface)
    : board_(board) {
  const std::filesystem::path found = find_image(board, image);
  if (!board.has_can_controller) {
    join_by_pipe(found);
  } else if (!interface.empty()) {
    join_by_can(found, interface);
  } else {
    throw host::UserError(fmt::format(
        "firmware {}: has a CAN controller of its own and needs an interface to join", board.name));
  }
}

void EmulatedNode::start(const std::vector<std::string>& words) {
  qemu_ = std::make_unique<ChildProcess>(words, folder_.path(), output());
}

// Makes the image exchange its frames by the pipes in its folder.
void EmulatedNode::join_by_pipe(const std::filesystem::path& image) {
  const Words words = command(board_, {"-M", board_.machine}, ",arg=pipe", image);
  host::make_frame_pipes(folder_.path());
  start(words);
  with_last_words([this] {
    pipe_ = std::make_unique<host::PipeLink>(folder_.path(), [this](bool gone) { watch(gone); });
    if (!host::await_boot_up(*pipe_)) fail("runs, but no node starts in it");
  });
}

// QEMU listens on its monitor before it starts the processor.
void EmulatedNode::join_by_can(const std::filesystem::path& image, const std::string& interface) {
  auto joined = std::make_unique<host::SocketLink>(interface);
  joined->await_echoes();  // the progress of QEMU counts from when QEMU has the frames
  auto socket = std::make_unique<WatchedLink>(std::move(joined), [this] { watch(); });
  start(command(board_, can_machine(board_, interface), "", image));
  with_last_words([&] {
    if (!host::await_boot_up(*socket, kCanBootPatience_ms)) fail("runs, but no node starts in it");
    const auto progress = [this,
                           monitor = std::make_shared<QemuMonitor>(folder_.path() / kMonitor)] {
      watch();
      return monitor->instructions();
    };
    can_ = std::make_unique<host::PacedLink>(std::move(socket), progress, kCanBurst,
                                             kInstructionsPerBurst);
  });
}

host::FrameLink& EmulatedNode::link() {
  if (pipe_) return *pipe_;
  return *can_;
}

// A pipe may break a moment before the process that held it has ended.
void EmulatedNode::watch(bool gone) {
  interruption_.check();
  const bool ended = gone ? qemu_->await_end(kEndPatience_ms) : !qemu_->running();
  if (ended) fail("QEMU " + qemu_->how_it_ended());
}

// Nothing on a CAN bus ends a node: there it only has to be alive.
void EmulatedNode::finish() {
  with_last_words([this] {
    if (!pipe_) return watch();
    pipe_->quit();
    if (!qemu_->await_end(kEndPatience_ms)) fail("does not end when it is asked to");
    if (!qemu_->ended_well()) fail("QEMU " + qemu_->how_it_ended());
  });
}

std::string EmulatedNode::last_words() const {
  std::ifstream stream(output());
  std::deque<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
    if (lines.size() > kLastLines) lines.pop_front();
  }
  return lines.empty() ? std::string()
                       : fmt::format("; the firmware said:\n  {}", fmt::join(lines, "\n  "));
}

void EmulatedNode::fail(const std::string& what) const {
  throw host::UserError(fmt::format("firmware {}: {}", board_.name, what));
}

}  // namespace volcomp::sim
