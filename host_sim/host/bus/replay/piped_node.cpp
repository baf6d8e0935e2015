#include "host_sim/host/bus/replay/piped_node.hpp"

#include <algorithm>

#include "firmware/canopen/cob_id.hpp"

namespace volcomp::host {
namespace {

constexpr std::uint64_t kLinger_us = 1000;
constexpr int kMostBootTurns = 10'000;

}  // namespace

PipedNode::PipedNode(std::uint8_t node_id, Start start, OnSent on_sent)
    : node_id_(node_id),
      model_(node_id, {},
             [this](std::uint64_t, const hal::CanFrame& frame) {
               booting_ = booting_ || is_boot_up(frame, node_id_);
             }),
      start_(std::move(start)),
      on_sent_(std::move(on_sent)) {}

void PipedNode::power_on(std::uint64_t time_us) {
  link_.reset();
  link_ = start_();
  unheard_ = false;
  time_us_ = time_us;
  begin_us_ = time_us - link_->now_us();
  model_.power_on(time_us);
  booting_ = false;
  on_sent_(time_us, {static_cast<std::uint16_t>(canopen::kHeartbeat + node_id_), 1, {0}});
}

void PipedNode::advance(std::uint64_t time_us) {
  while (model_.deadline_us() < time_us) {
    time_us_ = std::max(time_us_, model_.deadline_us());
    model_.advance(time_us_);
    model_.poll(time_us_);
    turn(0);
  }
  time_us_ = time_us;
  model_.advance(time_us);
}

void PipedNode::receive(const hal::CanFrame& frame, std::uint64_t time_us) {
  static_cast<void>(link_->send(frame));
  unheard_ = true;
  model_.receive(frame, time_us);
  if (frame.id == canopen::kSync) catch_up();  // from here its deadline counts
  if (frame.id == canopen::kNmt) await_boot_up();
}

void PipedNode::poll(std::uint64_t time_us) {
  model_.poll(time_us);
  catch_up();
}

void PipedNode::end_cycle() { catch_up(); }

bool PipedNode::linger() {
  turn(kLinger_us);
  return true;
}

void PipedNode::catch_up() {
  if (unheard_) turn(0);
}

void PipedNode::await_boot_up() {
  for (int i = 0; i < kMostBootTurns && booting_; ++i)
    turn(kLinger_us);
}

// A node that was given more time than the log did lives ahead of it for a while.
void PipedNode::turn(std::uint64_t least_us) {
  link_->turn(std::max(link_->now_us() + least_us, time_us_ - begin_us_));
  unheard_ = false;
  for (hal::CanFrame frame; link_->receive(frame);) {
    if (is_boot_up(frame, node_id_)) booting_ = false;
    on_sent_(time_us_, frame);
  }
}

}  // namespace volcomp::host
