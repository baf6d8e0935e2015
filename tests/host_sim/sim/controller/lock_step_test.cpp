// The controller keeps step with a node that is slower than the cycle.

#include <deque>

#include <gtest/gtest.h>

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint32_t kPeriod_us = 2000;

// From its start on it takes in one frame in each half of a cycle, fewer than the bus carries.
class SlowNode final : public host::FrameLink {
 public:
  explicit SlowNode(std::uint8_t id) : id_(id), node_(id, nullptr) { node_.power_on(0); }

  [[nodiscard]] bool send(const hal::CanFrame& frame) override {
    if (frame.id == canopen::kSync) {
      if (statuses_ > 0 && behind_ > 0) ++syncs_ahead_;
      ++behind_;
    }
    waiting_.push_back(frame);
    return true;
  }
  [[nodiscard]] bool receive(hal::CanFrame& frame) override {
    if (sent_.empty()) return false;
    frame = sent_.front();
    sent_.pop_front();
    if (frame.id == canopen::kTpdo1 + id_) ++statuses_;
    return true;
  }
  void wait(std::uint32_t) override {
    now_us_ += kPeriod_us / 2;
    do {
      take_in();
    } while (!started_ && !waiting_.empty());
  }
  [[nodiscard]] std::uint64_t now_us() const override { return now_us_; }
  [[nodiscard]] bool turn_by_turn() const override { return true; }

  [[nodiscard]] int statuses() const { return statuses_; }
  // SYNC messages that left, after the first status, while the node had not taken in the last one.
  [[nodiscard]] int syncs_ahead() const { return syncs_ahead_; }

 private:
  [[nodiscard]] bool is_start(const hal::CanFrame& frame) const {
    return frame.id == canopen::kNmt && frame.data[1] == id_ &&
           frame.data[0] == static_cast<std::uint8_t>(canopen::NmtCommand::start);
  }
  void take_in() {
    if (!waiting_.empty()) {
      const hal::CanFrame& frame = waiting_.front();
      if (frame.id == canopen::kSync) --behind_;
      started_ = started_ || is_start(frame);
      node_.device().receive(frame, now_us_);
      waiting_.pop_front();
    }
    node_.device().poll(now_us_);
    hal::CanFrame frame;
    while (node_.device().offer(frame, now_us_)) {
      node_.device().taken(now_us_);
      sent_.push_back(frame);
    }
  }

  std::uint8_t id_;
  node::Node node_;
  std::deque<hal::CanFrame> waiting_;
  std::deque<hal::CanFrame> sent_;
  std::uint64_t now_us_ = 0;
  bool started_ = false;
  int behind_ = 0;
  int statuses_ = 0;
  int syncs_ahead_ = 0;
};

// The cycle in which the first status came has its SYNC behind it: the next one leaves before the
// node has answered that, and no other.
TEST(LockStep, BeginsWithTheFirstStatusOfTheNode) {
  const host::MachineFile file = host::read_machine_file(host::bundled_machine("xyfz"));
  host::BusSettings settings = host::bus_settings(file, 1e6 / kPeriod_us);
  settings.heartbeat_ms = 1000;
  SlowNode node(settings.node);
  CanGateway gateway(node);
  BusAxes axes(settings, {}, gateway);
  axes.bring_up();
  const std::vector<std::int32_t> at_rest(settings.axes.size(), 0);
  for (int cycle = 0; cycle < 100; ++cycle)
    axes.run_cycle(at_rest);
  EXPECT_GT(node.statuses(), 100);
  EXPECT_LE(node.syncs_ahead(), 1);
}

}  // namespace
}  // namespace volcomp::sim
