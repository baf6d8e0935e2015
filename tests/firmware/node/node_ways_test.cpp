// Axes that the controller corrects (way 3), axes that nobody corrects (way 4), mixed machines, and
// drives that count in units of their own.

#include <cmath>

#include "comp/core/bytes.hpp"
#include "firmware/node/look_ahead.hpp"
#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtCommand;

constexpr std::int32_t kBegin = -100'000'000;

// A controller that adds to its next target what the node told it last.
class AddingController {
 public:
  AddingController() {
    bench.configure();
    for (std::uint8_t a = 1; a <= 3; ++a)
      EXPECT_EQ(bench.set<std::uint8_t>(0x2034, a, 3), AbortCode::none);
    for (BenchDrive& d : bench.drive)
      d.status = 0x0121;  // not enabled
    bench.load(bench_tables());
    bench.nmt(NmtCommand::start);
  }

  void cycle() {
    bench.sync();
    for (std::size_t a = 0; a < 3; ++a) {
      actual_[a] = commanded_[a];
      bench.drive[a].target = actual_[a];
      bench.drive[a].held = 0;
      bench.drive_data(a);
    }
    for (std::size_t a = 0; a < 3; ++a) {
      commanded_[a] = path[a] + added[a];
      bench.drive[a].target = commanded_[a];
      bench.controller_data(a);
    }
    bench.wait(NodeBench::kPeriod_us);
    for (const hal::CanFrame& f : bench.sent)
      take(f);
  }
  void cycles(int count) {
    for (int i = 0; i < count; ++i)
      cycle();
  }
  void enable() {
    for (BenchDrive& d : bench.drive)
      d.status = 0x0127;
  }

  NodeBench bench;
  std::array<std::int32_t, 3> path{kBegin, kBegin, kBegin};
  std::array<std::int32_t, 3> added{};
  std::int32_t largest_step = 0;
  int frames = 0;

 private:
  void take(const hal::CanFrame& f) {
    const bool xy = f.id == 0x200U + 127U;
    if (!xy && f.id != 0x300U + 127U) return;
    ++frames;
    ASSERT_EQ(f.size, xy ? 8 : 4);
    set(xy ? 0 : 2, f.data.data());
    if (xy) set(1, &f.data[4]);
  }
  void set(std::size_t axis, const std::uint8_t* bytes) {
    const auto value = static_cast<std::int32_t>(load_le(bytes, 4));
    largest_step = std::max(largest_step, std::abs(value - added[axis]));
    added[axis] = value;
  }
  std::array<std::int32_t, 3> actual_{kBegin, kBegin, kBegin};
  std::array<std::int32_t, 3> commanded_{kBegin, kBegin, kBegin};
};

// The offset of way 0 at this path, settled.
std::array<std::int32_t, 3> offsets_at(const std::array<std::int32_t, 3>& path) {
  NodeBench bench;
  for (std::size_t a = 0; a < 3; ++a)
    bench.drive[a].target = path[a];
  bench.configure();
  bench.load(bench_tables());
  bench.nmt(NmtCommand::start);
  bench.cycles(600);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  return bench.offsets();
}

TEST(NodeControllerAdds, SettlesWhereAnOffsetWould) {
  AddingController c;
  c.cycles(20);
  EXPECT_EQ(c.added, (std::array<std::int32_t, 3>{}));
  c.enable();
  c.cycles(600);
  EXPECT_EQ(c.bench.state(), NodeState::compensating);
  EXPECT_EQ(c.added, offsets_at(c.path));
  EXPECT_NE(c.added[0], 0);
  EXPECT_LE(c.largest_step, 20'000) << "2202h";
}

// At a steady speed: what acts a cycle late has gone on as it went. At the knots of the tables,
// where the slope changes, it is late as without.
TEST(NodeControllerAdds, GoesOnAsItWentLast) {
  AddingController c;
  NodeBench direct;
  direct.configure();
  direct.load(bench_tables());
  direct.nmt(NmtCommand::start);
  c.cycles(20);
  c.enable();
  constexpr std::int32_t kStep = 400'000;  // 0.2 m/s at 500 Hz
  double error = 0.0;
  double lag = 0.0;
  std::int32_t largest_error = 0;
  std::int32_t largest_lag = 0;
  std::array<std::int32_t, 3> before{};
  for (int i = 0; i < 900; ++i) {
    const std::int32_t step = i < 600 ? 0 : kStep / 10 * std::min(10, i - 600);
    for (std::size_t a = 0; a < 3; ++a) {
      c.path[a] += step;
      direct.drive[a].target = c.path[a];
    }
    direct.cycle();
    // What the controller adds in this cycle it heard in the last; it acts with this target.
    const std::array<std::int32_t, 3> acts = c.added;
    c.cycle();
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t wrong = acts[a] - direct.drive[a].next;
      const std::int32_t late = before[a] - direct.drive[a].next;
      before[a] = direct.drive[a].next;
      if (i < 700) continue;
      error += static_cast<double>(wrong) * wrong;
      lag += static_cast<double>(late) * late;
      largest_error = std::max(largest_error, std::abs(wrong));
      largest_lag = std::max(largest_lag, std::abs(late));
    }
  }
  EXPECT_GT(largest_lag, 20) << "or it makes no difference";
  EXPECT_LT(std::sqrt(error), 0.4 * std::sqrt(lag));
  EXPECT_LE(largest_error, 2 * largest_lag);
}

// A reversal or a jump is late, but nothing overshoots.
TEST(LookAheadOfOffsets, NeverOvershootsAJump) {
  LookAhead ahead;
  EXPECT_EQ(ahead.next(0), 0);
  EXPECT_EQ(ahead.next(10), 10);
  EXPECT_EQ(ahead.next(20), 30);
  EXPECT_EQ(ahead.next(1'020), 1'030) << "goes on by the smaller of two changes";
  EXPECT_EQ(ahead.next(1'020), 1'020);
  EXPECT_EQ(ahead.next(1'010), 1'010);
  EXPECT_EQ(ahead.next(1'020), 1'020) << "it turned";
}

// A controller that still adds an old offset: the node does not know which.
TEST(NodeControllerAdds, WaitsUntilTheAxesHaveBeenSeenDisabled) {
  AddingController c;
  c.enable();
  c.cycles(50);
  EXPECT_EQ(c.frames, 0);
  EXPECT_EQ(c.bench.state(), NodeState::waiting);
  for (std::uint8_t a = 1; a <= 3; ++a)
    ASSERT_EQ(c.bench.set<std::int32_t>(0x2206, a, 0), AbortCode::none) << "or it is told";
  c.cycles(50);
  EXPECT_GT(c.frames, 0);
}

// --- way 4

TEST(NodeWithoutWay, RefusesTablesThatCorrectTheAxis) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint8_t>(0x2034, 2, 4), AbortCode::none);
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(bench_tables())), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::general);
  EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), Reason::no_way);
  EXPECT_EQ(bench.number(0x2112, 3), static_cast<std::uint64_t>('Y'));
}

// Tables that were active before the way was taken away.
TEST(NodeWithoutWay, DoesNotStartWithTablesThatCorrectTheAxis) {
  NodeBench bench;
  bench.bring_up();
  bench.nmt(NmtCommand::enter_pre_operational);
  ASSERT_EQ(bench.set<std::uint8_t>(0x2034, 2, 4), AbortCode::none);
  bench.nmt(NmtCommand::start);
  bench.cycles(50);
  EXPECT_EQ(bench.state(), NodeState::waiting);
  EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), Reason::no_way);
  bench.nmt(NmtCommand::enter_pre_operational);
  ASSERT_EQ(bench.set<std::uint8_t>(0x2034, 2, 0), AbortCode::none);
  bench.nmt(NmtCommand::start);
  bench.cycles(50);
  EXPECT_EQ(bench.state(), NodeState::compensating);
}

// --- units per turn

// 2^40 run-time units a turn, whatever the drive counts: exact after any number of whole turns.
TEST(UnitsPerTurn, AnyNumberClosesAfterATurn) {
  for (const std::uint32_t per_turn :
       {1U, 3U, 3600U, 360'000U, 8192U, 131'071U, 1'000'003U, 0x0100'0000U, 0x0800'0000U}) {
    const WireScale scale{1, 1, true, per_turn};
    WirePosition position;
    constexpr std::int64_t kTurn = std::int64_t{1} << 40U;
    EXPECT_EQ(position.update(0, scale), 0);
    const std::int64_t most_turns = std::min<std::int64_t>(1000, INT32_MAX / per_turn);
    for (std::int64_t turn = 1; turn <= most_turns; ++turn) {
      const auto third = static_cast<std::int32_t>((turn - 1) * per_turn + per_turn / 3);
      const double exact = std::floor(static_cast<double>(third) / per_turn * 0x1p40);
      EXPECT_NEAR(static_cast<double>(position.update(third, scale)), exact, 1.0 + exact * 1e-15);
      EXPECT_EQ(position.update(static_cast<std::int32_t>(turn * per_turn), scale), turn * kTurn);
    }
    EXPECT_EQ(position.update(0, scale), 0) << per_turn;
    EXPECT_FALSE(position.lost());
  }
}

// A million turns: straight on where the range is whole turns, to and fro where it is not.
TEST(UnitsPerTurn, NoDriftInAMillionTurns) {
  constexpr std::int64_t kTurn = std::int64_t{1} << 40U;
  const WireScale counts{1, 1, true, 1U << 27U};
  WirePosition on;
  std::uint32_t wire = 0;
  for (int turn = 0; turn < 1'000'000; ++turn) {
    wire += 1U << 26U;
    static_cast<void>(on.update(static_cast<std::int32_t>(wire), counts));
    wire += 1U << 26U;
    const std::int64_t at = on.update(static_cast<std::int32_t>(wire), counts);
    ASSERT_EQ(at & (kTurn - 1), 0);
  }
  EXPECT_FALSE(on.lost());
  // After a restart it is the same place of the turn.
  WirePosition again;
  wire += 12'345'678U;
  EXPECT_EQ(again.update(static_cast<std::int32_t>(wire), counts) & (kTurn - 1),
            std::int64_t{12'345'678} << 13U);
  const WireScale degrees{1, 1, true, 3600};
  WirePosition to_and_fro;
  for (int swing = 0; swing < 500'000; ++swing) {
    static_cast<void>(to_and_fro.update(3600 * (swing % 7) + 1233, degrees));
    static_cast<void>(to_and_fro.update(-3600 * (swing % 5) - 7, degrees));
  }
  EXPECT_EQ(to_and_fro.update(3600, degrees), kTurn);
}

// The range of INTEGER32 is no whole number of these turns.
TEST(UnitsPerTurn, AWrapLosesTheTurn) {
  const WireScale degrees{1, 1, true, 3600};
  WirePosition position;
  static_cast<void>(position.update(INT32_MAX - 10, degrees));
  EXPECT_FALSE(position.lost());
  static_cast<void>(position.update(INT32_MIN + 10, degrees));
  EXPECT_TRUE(position.lost());
  position.reset();
  EXPECT_FALSE(position.lost());
}

// The speed of an axis at a touch: a turn is 2^40, whichever way the units are given.
TEST(UnitsPerTurn, SpeedsAreThoseOfTheFraction) {
  EXPECT_EQ(units_per_wire({1, 1, true, 1U << 24U}), units_per_wire({1U << 16U, 1, true}));
  EXPECT_DOUBLE_EQ(units_per_wire({1, 1, true, 3600}) * 3600, 0x1p40);
}

// Offsets and steps: 2^-32 turn to units, half to even, and never more than allowed.
TEST(UnitsPerTurn, OffsetsAreTheNearestUnit) {
  test::Random random(3);
  for (int i = 0; i < 100'000; ++i) {
    const auto per_turn = static_cast<std::uint32_t>(random.integer(1, UINT32_MAX));
    const auto offset = static_cast<std::int32_t>(random.integer(-4'194'303, 4'194'303));
    const WireScale scale{1, 1, true, per_turn};
    const long double exact = static_cast<long double>(offset) * per_turn / 0x1p32L;
    ASSERT_EQ(offset_to_wire(offset, scale), static_cast<std::int32_t>(std::nearbyint(exact)));
    ASSERT_EQ(step_to_wire(std::abs(offset), scale),
              static_cast<std::int32_t>(std::floor(std::abs(exact))));
    const std::int32_t wire = offset_to_wire(offset, scale);
    const long double back = static_cast<long double>(wire) * 0x1p32L / per_turn;
    if (std::abs(back) < 0x1p30L) {
      ASSERT_EQ(offset_from_wire(wire, scale), static_cast<std::int32_t>(std::nearbyint(back)));
    }
  }
}

}  // namespace
}  // namespace volcomp::node
