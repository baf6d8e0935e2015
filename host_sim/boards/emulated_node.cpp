#include "host_sim/boards/emulated_node.hpp"

#include <algorithm>
#include <deque>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/links/boot_up.hpp"

namespace volcomp::sim {
namespace {

constexpr const char* kEmulator = "qemu-system-arm";
constexpr int kEndPatience_ms = 10'000;
constexpr std::size_t kLastLines = 24;  // a whole fault report

std::filesystem::path find_emulator() {
  std::filesystem::path path = find_program(kEmulator);
  if (path.empty())
    throw UserError(
        fmt::format("{} is not installed (Debian: apt install {})", kEmulator, kEmulator));
  return path;
}

std::filesystem::path find_image(const EmulatedBoard& board, const std::filesystem::path& given) {
  const std::filesystem::path image = given.empty() ? node_image(board) : given;
  if (std::filesystem::is_regular_file(image)) return std::filesystem::absolute(image);
  if (!given.empty()) throw UserError(fmt::format("{}: no such file", given.string()));
  throw UserError(fmt::format(
      "{}: there is no image; build it first: cmake --preset {} && cmake --build --preset {}",
      image.lexically_normal().string(), board.name, board.name));
}

// One instruction every 64 ns of virtual time, which does not depend on anything else; the image is
// told to exchange its frames by the pipes in its folder.
std::vector<std::string> command(const EmulatedBoard& board, const std::filesystem::path& image) {
  return {find_emulator().string(),
          "-M",
          board.machine,
          "-nographic",
          "-monitor",
          "none",
          "-serial",
          "stdio",
          "-semihosting-config",
          "enable=on,target=native,arg=volcomp-node,arg=pipe",
          "-icount",
          "shift=6,sleep=off",
          "-kernel",
          image.string()};
}

}  // namespace

const EmulatedBoard& emulated_board(const std::string& name) {
  for (const EmulatedBoard& board : kEmulatedBoards) {
    if (name == board.name) return board;
  }
  throw UserError(fmt::format("{}: there is no firmware for such a board", name));
}

std::filesystem::path node_image(const EmulatedBoard& board) {
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  const std::filesystem::path builds = self.parent_path() / "../..";
  return builds / board.name / "firmware" / fmt::format("volcomp-node-{}.elf", board.name);
}

EmulatedNode::EmulatedNode(const EmulatedBoard& board, const std::filesystem::path& image)
    : board_(board) {
  const std::vector<std::string> words = command(board, find_image(board, image));
  make_frame_pipes(folder_.path());
  qemu_ = std::make_unique<ChildProcess>(words, folder_.path(), output());
  with_last_words([this] {
    link_ = std::make_unique<PipeLink>(folder_.path(), [this](bool gone) { watch(gone); });
    if (!await_boot_up(*link_)) fail("runs, but no node starts in it");
  });
}

// A pipe may break a moment before the process that held it has ended.
void EmulatedNode::watch(bool gone) {
  interruption_.check();
  const bool ended = gone ? qemu_->await_end(kEndPatience_ms) : !qemu_->running();
  if (ended) fail("QEMU " + qemu_->how_it_ended());
}

void EmulatedNode::finish() {
  with_last_words([this] {
    link_->quit();
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
  throw UserError(fmt::format("firmware {}: {}", board_.name, what));
}

}  // namespace volcomp::sim
