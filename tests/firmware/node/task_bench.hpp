#pragma once
// A node task on a board made of plain objects: a port that is filled turn by turn, a clock that is
// set, a section that knows what may not happen in it, a watchdog that bites. Around it the bus:
// SYNC every second turn, three drives, a controller, an SDO client.

#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "firmware/canopen/sdo_client.hpp"
#include "firmware/node/node_task.hpp"
#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {

struct BenchClock {
  std::uint64_t us = 0;
  [[nodiscard]] std::uint64_t now_us() const { return us; }
};

struct BenchPort {
  std::deque<hal::CanFrame> in;
  std::vector<hal::CanFrame> out;
  std::size_t room = SIZE_MAX;  // frames send() still takes

  bool send(const hal::CanFrame& frame);
  bool receive(hal::CanFrame& frame);
};

struct BenchSection {
  bool inside = false;
  int misuses = 0;  // entered or left twice
  std::function<void()> on_enter;
  std::function<void()> on_leave;  // plays the interrupt that waited

  void enter();
  void leave();
};

struct BenchWatchdog {
  const BenchClock& clock;
  std::uint32_t time_us = 20'000;
  std::uint64_t fed_us = 0;

  void feed() { fed_us = bites() ? fed_us : clock.us; }
  [[nodiscard]] std::uint32_t remaining_us() const {
    return bites() ? 0 : time_us - static_cast<std::uint32_t>(clock.us - fed_us);
  }
  [[nodiscard]] bool bites() const { return clock.us - fed_us >= time_us; }
};

// The bus of one turn, seen from the node. The same frames can be given to several nodes.
class BenchBus {
 public:
  // SYNC in every second turn, what drives and controller send after it, and what was put().
  std::vector<hal::CanFrame> turn();
  void put(const hal::CanFrame& frame) { extra_.push_back(frame); }
  void nmt(canopen::NmtCommand command);
  // What the node sent: the drives take their offsets.
  void hear(const hal::CanFrame& frame);

  std::array<BenchDrive, NodeBench::kDrives> drive;
  std::int32_t largest_step = 0;  // of an offset a drive took in
  bool with_sync = true;

 private:
  std::vector<hal::CanFrame> extra_;
  std::uint8_t counter_ = 0;
  bool sync_turn_ = false;
};

using BenchTask = NodeTask<BenchPort, BenchClock, BenchSection, BenchWatchdog>;

class TaskBench final : public BenchDevice {
 public:
  static constexpr std::uint8_t kId = NodeBench::kId;
  static constexpr std::uint64_t kTurn_us = 1000;
  using Frames = std::vector<hal::CanFrame>;

  explicit TaskBench(Storage* storage = nullptr, const GuardianSettings& guardian = {},
                     ResetCause cause = ResetCause::power_on);

  // One millisecond: the interrupt with the frames of the bus, then the background until it has
  // nothing to do, unless it hangs.
  void turn();
  void turns(int count);
  // The interrupt alone, as it may come at any moment. `on_interrupt` receives what came and left.
  void interrupt();

  // As many turns as it takes.
  canopen::AbortCode write(canopen::ObjectId object, const Bytes& value) override;
  // Drives, period, ramp; tables; NMT start; until every offset has settled.
  void configure();
  void bring_up(const MachineTables& tables = bench_tables());

  [[nodiscard]] NodeState state() const {
    return static_cast<NodeState>(task->node().objects().state);
  }
  [[nodiscard]] bool offsets_are_zero() const;

  BenchClock clock;
  BenchPort port;
  BenchSection section;
  BenchWatchdog watchdog{clock};
  BenchBus bus;
  std::uint64_t turn_us = kTurn_us;
  bool background_hangs = false;
  Frames sent;  // in the last interrupt
  std::function<void(const Frames& in, const Frames& out)> on_interrupt;
  std::function<void()> background;  // instead of the steps that are due
  std::unique_ptr<BenchTask> task;

 private:
  canopen::AbortCode finish();
};

}  // namespace volcomp::node
