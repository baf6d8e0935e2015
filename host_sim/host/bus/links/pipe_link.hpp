#pragma once
// The host's end of a frame pipe (hal/frame_pipe.hpp): turn by turn with firmware on an emulated
// board, or with volcomp-node.
//
// wait() is one turn: everything sent since the last one goes out, every frame of the node comes
// in. The node's millisecond passes whether or not there are frames.

#include <deque>
#include <filesystem>
#include <functional>
#include <vector>

#include "hal/frame_pipe.hpp"
#include "host_sim/host/bus/links/descriptor.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"

namespace volcomp::host {

// Makes the two pipes in the folder; those that are there stay. Throws UserError naming the folder.
void make_frame_pipes(const std::filesystem::path& folder);

class PipeLink final : public FrameLink {
 public:
  // Called at every turn, several times a second while the other end is awaited, and once when it
  // is gone. May throw, which ends the waiting with the reason of the other end.
  using Watch = std::function<void(bool gone)>;

  // Makes the pipes where they are missing and waits some seconds for the other end. Throws
  // UserError naming the folder.
  explicit PipeLink(const std::filesystem::path& folder, Watch watch = {});

  [[nodiscard]] bool send(const hal::CanFrame& frame) override;
  [[nodiscard]] bool receive(hal::CanFrame& frame) override;
  // Throws UserError when the other end is gone, does not answer or breaks the protocol; so do all
  // the others that write.
  void wait(std::uint32_t /*timeout_us*/) override { turn(now_us_ + hal::kPipeTurn_us); }
  // The same, with the node's clock at that time, which must not go back.
  void turn(std::uint64_t now_us);
  [[nodiscard]] std::uint64_t now_us() const override { return now_us_; }
  [[nodiscard]] bool turn_by_turn() const override { return true; }

  // Ends the node; no call may follow.
  void quit();

 private:
  void open_pipes();
  void write_turn();
  void read_turn();
  [[nodiscard]] bool take_records();
  void await(int descriptor, short events) const;
  void look() const;
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void gone() const;

  BrokenPipeIgnored broken_pipe_ignored_;
  std::filesystem::path folder_;
  Watch watch_;
  Descriptor to_node_;
  Descriptor from_node_;
  std::vector<std::uint8_t> outgoing_;
  std::vector<std::uint8_t> incoming_;  // read, not yet a whole record
  std::deque<hal::CanFrame> received_;
  std::uint64_t now_us_ = 0;  // the node's clock
};

}  // namespace volcomp::host
