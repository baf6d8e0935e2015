#pragma once
// The compensation node as firmware: executes its image on a board that QEMU emulates.
//
// Boards without a CAN controller are joined by a frame pipe: the processor stands still while this
// process works, so a run repeats bit for bit. The controller of the others is joined to a
// SocketCAN interface by QEMU.

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "host_sim/host/bus/links/pipe_link.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/sim/boards/child_process.hpp"

namespace volcomp::sim {

struct EmulatedBoard {
  const char* name;       // on the command line, and of the CMake preset
  const char* machine;    // QEMU's name of the board
  const char* processor;  // for people
  std::size_t knots;      // per table: VOLCOMP_NODE_KNOTS of the preset
  bool has_can_controller;
};

inline constexpr std::array<EmulatedBoard, 3> kEmulatedBoards{
    {{"m7", "mps2-an500", "Cortex-M7", 128, false},
     {"m4", "mps2-an386", "Cortex-M4F", 64, false},
     {"a53", "virt", "Cortex-A53", 128, true}}};

// Throws UserError for an unknown name.
[[nodiscard]] const EmulatedBoard& emulated_board(const std::string& name);

// Where the build puts the image of the node, beside the build this program comes from.
[[nodiscard]] std::filesystem::path node_image(const EmulatedBoard& board);

class EmulatedNode {
 public:
  // Starts the image; empty: node_image(). `interface`: where the CAN controller of the board is
  // joined, for boards that have one. Throws UserError naming what is missing.
  EmulatedNode(const EmulatedBoard& board, const std::filesystem::path& image,
               const std::string& interface = {});
  EmulatedNode(const EmulatedNode&) = delete;
  EmulatedNode& operator=(const EmulatedNode&) = delete;
  // Ends QEMU.
  ~EmulatedNode() = default;

  // Throws UserError when the firmware has ended, and Interrupted at a signal that ends this
  // process.
  [[nodiscard]] host::FrameLink& link();
  // Boards without a CAN controller only.
  [[nodiscard]] host::PipeLink& pipe() { return *pipe_; }
  // Ends the firmware, where there is a way. Throws UserError when it has not ended well.
  void finish();

  // Does the work; adds the last output of the firmware to the message of an error.
  template <class Work>
  auto with_last_words(Work&& work) {
    try {
      return work();
    } catch (const host::UserError& error) {
      throw host::UserError(error.what() + last_words());
    }
  }
  // The end of the firmware's output, as the end of a message; empty without output.
  [[nodiscard]] std::string last_words() const;

  [[nodiscard]] pid_t process_id() const { return qemu_->id(); }

 private:
  void start(const std::vector<std::string>& words);
  void join_by_pipe(const std::filesystem::path& image);
  void join_by_can(const std::filesystem::path& image, const std::string& interface);
  void watch(bool gone = false);
  [[nodiscard]] std::filesystem::path output() const { return folder_.path() / "output.txt"; }
  [[noreturn]] void fail(const std::string& what) const;

  EmulatedBoard board_;
  host::Interruption interruption_;
  host::TemporaryFolder folder_;
  std::unique_ptr<ChildProcess> qemu_;
  std::unique_ptr<host::PipeLink> pipe_;
  std::unique_ptr<host::FrameLink> can_;
};

}  // namespace volcomp::sim
