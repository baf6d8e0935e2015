// The lookup where integers and tables end: knots ± 1 nm, both ends, far beyond, and positions no
// machine has.

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();

// Both directions alike, so that only the position matters.
MachineTables one_direction_tables(Random& random) {
  MachineTables tables = xyfz_tables(40e3, 4e-5, random);
  for (AxisTable& table : tables.axis)
    table.value[1] = table.value[0];
  return tables;
}

class XyfzEdges : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(loaded.start(tables).ok());
    ASSERT_TRUE(compiled.start(tables).ok());
  }

  void expect_agreement(const std::array<std::int64_t, 3>& q) {
    loaded.tick({q[0], q[1], q[2], 0, 0});
    compiled.tick(q);
    model.stand_at({q[0], q[1], q[2]}, {});
    const Real3 e = model.first_order();
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_LT(std::abs(static_cast<double>(loaded.out.offset[a] + e[a])), 1.0)
          << "at " << q[0] << ' ' << q[1] << ' ' << q[2] << " axis " << a;
      ASSERT_EQ(loaded.out.offset[a], compiled.out.offset[a]);
      ASSERT_EQ(loaded.out.status[a], compiled.out.status[a]);
    }
  }

  Random random{3};
  MachineTables tables = one_direction_tables(random);
  LoadedRunner loaded{kXyfzMachine};
  XyfzRunner compiled;
  MachineModel model{tables, kXyfzMachine.tool_point};
};

TEST_F(XyfzEdges, EveryKnotAndItsNeighbours) {
  SCOPED_TRACE(random.trace());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisTable& t = tables.axis[axis];
    for (std::uint32_t i = 0; i < t.knots; ++i) {
      for (const std::int64_t step : {-2, -1, 0, 1, 2}) {
        std::array<std::int64_t, 3> q{-123'456'789, -234'567'890, -345'678'901};
        q[axis] = t.q0 + t.pitch * static_cast<std::int64_t>(i) + step;
        expect_agreement(q);
      }
    }
  }
}

TEST_F(XyfzEdges, ImpossiblePositionsStandAtTheEnd) {
  SCOPED_TRACE(random.trace());
  constexpr std::int64_t kEnd = 10'000'000'000'000;
  for (const std::int64_t far :
       {kMin, kMin + 1, -kEnd - 1, -kEnd, -kEnd + 1, -kEnd - 500'000'000, kEnd - 1, kEnd, kEnd + 1,
        kMax - 1, kMax, std::int64_t{-4'294'967'296}, std::int64_t{4'294'967'296},
        std::int64_t{-4'294'967'296 - 500'000'000}}) {
    expect_agreement({far, -100'000'000, -100'000'000});
    expect_agreement({-100'000'000, far, -100'000'000});
    expect_agreement({-100'000'000, -100'000'000, far});
    expect_agreement({far, far, far});
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_EQ(loaded.out.status[a] & (kOutOfRange | kFarOutOfRange),
                kOutOfRange | kFarOutOfRange);
  }
}

// OUT_OF_RANGE from the first nanometre outside; FAR from the first one beyond half a pitch.
TEST_F(XyfzEdges, RangeFlagsBeginAtTheRightNanometre) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisTable& t = tables.axis[axis];
    const std::int64_t half = t.pitch / 2;
    const auto flags = [&](std::int64_t q) {
      LoadedRunner::Positions at{-100'000'000, -100'000'000, -100'000'000, 0, 0};
      at[axis] = q;
      return loaded.tick(at).status[axis] & (kOutOfRange | kFarOutOfRange);
    };
    EXPECT_EQ(flags(t.q0), 0);
    EXPECT_EQ(flags(t.last()), 0);
    EXPECT_EQ(flags(t.q0 - 1), kOutOfRange);
    EXPECT_EQ(flags(t.last() + 1), kOutOfRange);
    EXPECT_EQ(flags(t.q0 - half), kOutOfRange);
    EXPECT_EQ(flags(t.last() + half), kOutOfRange);
    EXPECT_EQ(flags(t.q0 - half - 1), kOutOfRange | kFarOutOfRange);
    EXPECT_EQ(flags(t.last() + half + 1), kOutOfRange | kFarOutOfRange);
  }
}

// Beyond its end an axis changes nothing any more: neither error nor lever arms.
TEST_F(XyfzEdges, CorrectionIsConstantBeyondTheEnds) {
  for (const std::int64_t out : {std::int64_t{1}, std::int64_t{7'000'000}, kMax / 2}) {
    const auto inside = loaded.tick({0, -300'000'000, 0, 0, 0}).offset;
    const auto outside = loaded.tick({out, -300'000'000 - out, out, 0, 0}).offset;
    EXPECT_EQ(inside, outside);
  }
}

// Continuity: 1 nm of motion changes no output by more than the contraction allows plus rounding.
TEST_F(XyfzEdges, NoStepAnywhereAlongATravel) {
  SCOPED_TRACE(random.trace());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisTable& t = tables.axis[axis];
    for (int n = 0; n < 20'000; ++n) {
      const std::int64_t knot = t.q0 + t.pitch * random.integer(0, t.knots - 1);
      LoadedRunner::Positions q{-200'000'000, -200'000'000, -200'000'000, 0, 0};
      q[axis] = knot + random.integer(-3, 3);
      const auto here = loaded.tick(q).offset;
      ++q[axis];
      const auto next = loaded.tick(q).offset;
      for (std::size_t a = 0; a < 3; ++a)
        ASSERT_LE(std::abs(next[a] - here[a]), 1) << "at " << q[axis] << " axis " << axis;
    }
  }
}

// Longest and shortest tables: 4.29 m in two knots, 1 nm pitch, full capacity.
TEST(LookupShapes, ExtremeTablesInterpolateTheIdentity) {
  struct Shape {
    std::int64_t q0, pitch;
    std::uint32_t knots;
  };
  for (const Shape& s : {Shape{-2'000'000'000, 4'294'967'295, 2}, Shape{0, 1, 2}, Shape{5, 1, 128},
                         Shape{-7, 3, 100}, Shape{-1'000'000'007, 33'818'639, 128},
                         Shape{9'999'000'000'000, 1'000'003, 128}}) {
    MachineTables tables;
    tables.machine = kXyfzMachine;
    for (std::size_t a = 0; a < 3; ++a) {
      tables.axis[a].q0 = s.q0;
      tables.axis[a].pitch = s.pitch;
      tables.axis[a].knots = s.knots;
    }
    const double rise = std::min(1000.0, 5e-3 * static_cast<double>(s.pitch));  // nm per knot
    for (auto& column : tables.axis[0].value) {
      for (std::uint32_t i = 0; i < s.knots; ++i)
        column[i][0] = static_cast<float>(rise * i);
    }
    LoadedRunner runner(kXyfzMachine);
    ASSERT_TRUE(runner.start(tables).ok());
    Random random(4);
    SCOPED_TRACE(random.trace());
    const std::int64_t last = s.q0 + s.pitch * (static_cast<std::int64_t>(s.knots) - 1);
    for (int n = 0; n < 20'000; ++n) {
      const std::int64_t q = random.integer(s.q0 - 2, last + 2);
      const std::int64_t held = std::min(std::max(q, s.q0), last);
      runner.tick({q, s.q0, s.q0, 0, 0});
      // body value of a workpiece axis: error −δ, offset +δ
      const double want = rise * (static_cast<double>(held - s.q0) / static_cast<double>(s.pitch));
      const double got = -static_cast<double>(runner.compensator->last_error_nm()[0]);
      ASSERT_NEAR(got, want, 1e-3 * rise + 1e-6 * want) << "q " << q << " pitch " << s.pitch;
    }
  }
}

}  // namespace
}  // namespace volcomp::test
