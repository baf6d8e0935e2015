#include "tests/firmware/node/forwarding_bench.hpp"

#include <algorithm>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"

namespace volcomp::node {

using canopen::AbortCode;

namespace {

constexpr std::int32_t kBegin = -100'000'000;  // nm, well inside the tables
constexpr std::uint16_t kEnable = 0x0F;        // 6040h
constexpr std::uint16_t kDisable = 0x06;

}  // namespace

// --- life

void ForwardingBench::configure() {
  bench.configure();
  if (!counts_sync) {
    EXPECT_EQ(bench.set<std::uint32_t>(0x1006, 0, 0), AbortCode::none);
    EXPECT_EQ(bench.set<std::uint8_t>(0x1019, 0, 0), AbortCode::none);
    EXPECT_EQ(bench.set<std::uint32_t>(0x1006, 0, NodeBench::kPeriod_us), AbortCode::none);
  }
  EXPECT_EQ(bench.set<std::uint8_t>(0x1029, 1, 1), AbortCode::none);
  EXPECT_EQ(bench.set<std::uint16_t>(0x1017, 0, 2), AbortCode::none);
  for (std::uint8_t a = 1; a <= kDrives; ++a) {
    EXPECT_EQ(bench.set<std::uint8_t>(0x2034, a, 1), AbortCode::none);
    EXPECT_EQ(bench.set<std::uint32_t>(0x1016, a, std::uint32_t{a} << 16U | 60'000U),
              AbortCode::none);
    EXPECT_EQ(bench.set<std::int32_t>(0x2202, a, slew), AbortCode::none);
    EXPECT_EQ(bench.set<std::int32_t>(0x2203, a, soft_rate), AbortCode::none);
    EXPECT_EQ(bench.set<std::int32_t>(0x2201, a, kLimit), AbortCode::none);
  }
}

void ForwardingBench::confirm_mapping() {
  for (std::uint8_t a = 1; a <= kDrives; ++a) {
    bench.give({static_cast<std::uint16_t>(canopen::kHeartbeat + a), 1, {5}});
    ASSERT_EQ(bench.set<std::uint8_t>(0x2037, a, 1), AbortCode::none);
  }
}

void ForwardingBench::bring_up() {
  for (FollowingDrive& d : drive)
    d.actual = d.target = kBegin;
  configure();
  bench.load(bench_tables());
  confirm_mapping();
  start();
  cycles(20);
}

void ForwardingBench::restart_node() {
  held_.clear();
  stalled_ = false;
  bench.port_full = false;
  for (std::optional<Heard>& heard : heard_)
    heard.reset();
  bench.power_on();
  configure();
  bench.load(bench_tables());
  confirm_mapping();
  start();
}

// A controller sets its target to 6064h before it enables a drive.
void ForwardingBench::enable(bool on) {
  for (FollowingDrive& d : drive) {
    if (on && !d.enabled) d.target = d.actual;
    d.enabled = on;
  }
}

void ForwardingBench::home(bool homing) {
  for (FollowingDrive& d : drive) {
    if (!homing) d.target = d.actual;
    d.mode = homing ? 6 : 8;
  }
}

void ForwardingBench::boot(std::size_t axis) {
  collect();
  mapped.at(axis) = false;
  bench.give({static_cast<std::uint16_t>(canopen::kHeartbeat + axis + 1), 1, {0}});
}

void ForwardingBench::move(std::int32_t by) {
  for (FollowingDrive& d : drive)
    d.target += by;
}

// --- to the node

void ForwardingBench::hear_now(const hal::CanFrame& frame, std::uint64_t sent) {
  bench.node->device().receive(frame, bench.now_us);
  const unsigned axis = frame.id - 0x201U;
  if (axis < kDrives && bench.node->device().state() == canopen::NmtState::operational)
    heard_[axis] = Heard{static_cast<std::int32_t>(load_le(&frame.data[2], 4)), sent};
}

void ForwardingBench::give(const hal::CanFrame& frame) {
  if (random_.chance(faults.lost)) return;
  if (random_.chance(faults.late)) {
    late_in_.push_back({static_cast<int>(random_.integer(1, 2)), frame, cycle_});
    return;
  }
  const int times = random_.chance(faults.doubled) ? 2 : 1;
  for (int i = 0; i < times; ++i) {
    if (stalled_)
      held_.push_back({frame, cycle_});
    else
      hear_now(frame, cycle_);
  }
}

// All that has come is taken in before anything is sent, as a loop around a port does.
void ForwardingBench::stall(bool stalled) {
  stalled_ = stalled;
  if (stalled) return;
  for (const HeldFrame& held : held_)
    hear_now(held.frame, held.sent);
  held_.clear();
}

hal::CanFrame ForwardingBench::sync_frame(std::uint8_t counter) const {
  hal::CanFrame f = bench_frame(canopen::kSync, counts_sync ? 1 : 0);
  if (counts_sync) f.data[0] = counter;
  return f;
}

void ForwardingBench::foreign_sync() {
  collect();
  take_all();
  give(sync_frame(static_cast<std::uint8_t>((counter_ + 100) % 240 + 1)));
}

void ForwardingBench::status(std::size_t axis) {
  const FollowingDrive& d = drive[axis];
  hal::CanFrame f = bench_frame(0x181U + static_cast<unsigned>(axis), 7);
  store_le(f.data.data(), 4, static_cast<std::uint32_t>(d.actual));
  const unsigned word = (d.enabled ? 0x0027U : 0x0021U) | (d.referenced ? 0x0100U : 0U);
  store_le(&f.data[4], 2, word);
  f.data[6] = static_cast<std::uint8_t>(d.mode);
  give(f);
}

void ForwardingBench::target(std::size_t axis) {
  hal::CanFrame f = bench_frame(0x201U + static_cast<unsigned>(axis), 6);
  store_le(f.data.data(), 2, drive[axis].enabled ? kEnable : kDisable);
  store_le(&f.data[2], 4, static_cast<std::uint32_t>(drive[axis].target));
  give(f);
}

// --- from the node

// Whatever the node sends is a target of the controller that came since the last one, plus an
// offset.
void ForwardingBench::collect() {
  for (const hal::CanFrame& f : bench.sent) {
    if (f.id == canopen::kHeartbeat + kBenchId) ++heartbeats_;
    const unsigned axis = f.id - 0x301U;
    if (axis >= kDrives) continue;
    ++frames_;
    ASSERT_EQ(f.size, 4);
    ASSERT_TRUE(heard_[axis].has_value()) << "a target that the controller has not sent";
    // Two cycles late on the bus, and as many that the node may stand still (2200h:04).
    ASSERT_LE(cycle_ - heard_[axis]->cycle, 4U) << "an old target";
    ASSERT_TRUE(mapped[axis]) << "a drive that would take it for something else";
    deliver(axis, {heard_[axis]->target, static_cast<std::int32_t>(load_le(f.data.data(), 4))});
    heard_[axis].reset();
  }
  bench.sent.clear();
}

void ForwardingBench::deliver(std::size_t axis, const ForwardedTarget& target) {
  ASSERT_LE(std::abs(target.offset()), kLimit);
  if (random_.chance(faults.lost)) return;
  if (random_.chance(faults.late)) {
    late_out_.push_back({static_cast<int>(random_.integer(1, 2)), axis, target});
    return;
  }
  drive[axis].waits = target;
}

// One that does not follow takes its own position as target.
void ForwardingBench::take(FollowingDrive& d) {
  if (!d.follows()) {
    d.waits.reset();
    d.taken.reset();
    return;
  }
  if (!d.waits) return;
  if (!d.taken) {
    ASSERT_EQ(d.waits->offset(), 0) << "switching on adds nothing";
  } else {
    ASSERT_LE(std::abs(d.waits->offset() - d.taken->offset()), slew);
  }
  d.actual = d.unmoved ? d.waits->target : d.waits->sent;
  d.taken = d.waits;
  d.waits.reset();
}

void ForwardingBench::pass_late() {
  const auto take_due = [](auto& list, const auto& act) {
    for (auto it = list.begin(); it != list.end();) {
      if (--it->cycles > 0) {
        ++it;
        continue;
      }
      act(*it);
      it = list.erase(it);
    }
  };
  take_due(late_in_, [this](const LateFrame& late) {
    if (stalled_)
      held_.push_back({late.frame, late.sent});
    else
      hear_now(late.frame, late.sent);
  });
  take_due(late_out_, [this](const LateTarget& late) { drive[late.axis].waits = late.target; });
}

// --- cycle

// SYNC may be lost at one of the drives.
void ForwardingBench::take_all() {
  for (FollowingDrive& d : drive) {
    if (!random_.chance(faults.lost)) take(d);
  }
}

void ForwardingBench::cycle() {
  collect();
  if (sync_speaks) take_all();
  if (testing::Test::HasFatalFailure()) return;
  frames_ = 0;
  ++cycle_;
  counter_ = static_cast<std::uint8_t>(counter_ % 240 + 1);
  if (sync_speaks) give(sync_frame(counter_));
  pass_late();
  for (std::size_t a = 0; a < kDrives; ++a) {
    if (drives_speak) status(a);
    if (controller_speaks) target(a);
  }
  if (stalled_)
    bench.now_us += NodeBench::kPeriod_us;
  else
    bench.wait(NodeBench::kPeriod_us);
  collect();
}

void ForwardingBench::cycles(int count) {
  for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i)
    cycle();
}

}  // namespace volcomp::node
