#include "host_sim/host/bus/replay/piped_node.hpp"

#include <algorithm>
#include <utility>

#include "firmware/canopen/cob_id.hpp"

namespace volcomp::host {
namespace {

constexpr std::uint64_t kLinger_us = 1000;
constexpr int kMostTurns = 10'000;

}  // namespace

PipedNode::PipedNode(std::uint8_t node_id, Start start, OnSent on_sent)
    : ReplayedNode(node_id, {},
                   [this](const hal::CanFrame& frame) { ahead_ += counts(frame) ? 1U : 0U; }),
      node_id_(node_id),
      start_(std::move(start)),
      on_sent_(std::move(on_sent)) {}

// Frames that leave by the clock of each node do not count.
bool PipedNode::counts(const hal::CanFrame& frame) const {
  if (frame.id == canopen::kHeartbeat + node_id_) return is_boot_up(frame, node_id_);
  return frame.id != canopen::kEmergency + node_id_ && !is_timed(frame.id);
}

void PipedNode::power_on(std::uint64_t time_us) {
  link_.reset();
  link_ = start_();
  begin_us_ = time_us - link_->now_us();
  unheard_ = false;
  ReplayedNode::power_on(time_us);
  said_ = ahead_;
  on_sent_({static_cast<std::uint16_t>(canopen::kHeartbeat + node_id_), 1, {0}});
}

void PipedNode::receive(const hal::CanFrame& frame, std::uint64_t time_us) {
  const bool sync = frame.id == canopen::kSync;
  if (sync && unheard_) turn(0);
  static_cast<void>(link_->send(frame));
  unheard_ = true;
  ReplayedNode::receive(frame, time_us);
  if (sync) turn(0);  // from here its deadline counts
  follow();
}

void PipedNode::pass_deadline() {
  ReplayedNode::pass_deadline();
  turn(0);
  follow();
}

void PipedNode::follow() {
  if (said_ < ahead_ && unheard_) turn(0);
  for (int i = 0; i < kMostTurns && said_ < ahead_; ++i)
    turn(kLinger_us);
  said_ = ahead_;
}

// A node that has been given more time than the log is ahead of it for a while.
void PipedNode::turn(std::uint64_t least_us) {
  link_->turn(std::max(link_->now_us() + least_us, now_us() - begin_us_));
  unheard_ = false;
  for (hal::CanFrame frame; link_->receive(frame);) {
    said_ += counts(frame) ? 1U : 0U;
    on_sent_(frame);
  }
}

}  // namespace volcomp::host
