#pragma once
// A node behind a frame pipe into which a log is replayed: firmware on an emulated board. The base
// class runs a node in this process ahead of it, which shows when the other has a frame to send.
//
// The pipe's turns carry the node's time. There is one before and at every SYNC, at a deadline, and
// when the node in this process has sent a frame: the other then gets time until it has sent as
// many, its boot-up after a command to reset, too. A turn in between would change nothing.

#include "host_sim/host/bus/links/pipe_link.hpp"
#include "host_sim/host/bus/replay/replayed_node.hpp"

namespace volcomp::host {

class PipedNode final : public ReplayedNode {
 public:
  // Starts a fresh node and returns its link when it has booted (links/boot_up.hpp).
  using Start = std::function<std::shared_ptr<PipeLink>()>;

  PipedNode(std::uint8_t node_id, Start start, OnSent on_sent);

  // All throw what starting the node or its link throws.
  void power_on(std::uint64_t time_us) override;
  void receive(const hal::CanFrame& frame, std::uint64_t time_us) override;
  void pass_deadline() override;

 private:
  [[nodiscard]] bool counts(const hal::CanFrame& frame) const;
  void follow();
  void turn(std::uint64_t least_us);

  std::uint8_t node_id_;
  Start start_;
  OnSent on_sent_;
  std::shared_ptr<PipeLink> link_;
  std::uint64_t begin_us_ = 0;  // where the time of the link began
  std::uint64_t ahead_ = 0;     // frames that count, of the node in this process
  std::uint64_t said_ = 0;      // and of the other
  bool unheard_ = false;        // frames have been sent that the node gets with the next turn
};

}  // namespace volcomp::host
