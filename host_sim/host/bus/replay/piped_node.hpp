#pragma once
// A node behind a frame pipe that lives through a recorded past: firmware on an emulated board. A
// node in this process goes with it and tells what belongs to it.
//
// The pipe's turns carry the log's time. There is one before and at every SYNC, at every deadline,
// and when the log lets the node speak; in between a turn could change nothing. Only a command to
// reset takes turns of its own, until the node has booted: it does so in its background, and what
// comes next on the bus must not overtake it.

#include "host_sim/host/bus/links/pipe_link.hpp"
#include "host_sim/host/bus/replay/replayed_node.hpp"

namespace volcomp::host {

class PipedNode final : public ReplaySubject {
 public:
  // Starts a fresh node and returns its link when it has booted (links/boot_up.hpp).
  using Start = std::function<std::shared_ptr<PipeLink>()>;

  PipedNode(std::uint8_t node_id, Start start, OnSent on_sent);

  // All throw what starting the node or its link throws.
  void power_on(std::uint64_t time_us) override;
  void advance(std::uint64_t time_us) override;
  void receive(const hal::CanFrame& frame, std::uint64_t time_us) override;
  void poll(std::uint64_t time_us) override;
  void end_cycle() override;
  bool linger() override;
  [[nodiscard]] const ReplayedNode& model() const override { return model_; }

 private:
  void turn(std::uint64_t least_us);
  void catch_up();
  void await_boot_up();

  std::uint8_t node_id_;
  ReplayedNode model_;
  Start start_;
  OnSent on_sent_;
  std::shared_ptr<PipeLink> link_;
  std::uint64_t time_us_ = 0;   // the log's
  std::uint64_t begin_us_ = 0;  // the log's, where the node's own time began
  bool unheard_ = false;        // frames have been sent that the node gets with the next turn
  bool booting_ = false;        // the model has been reset and has booted, the node has not yet
};

}  // namespace volcomp::host
