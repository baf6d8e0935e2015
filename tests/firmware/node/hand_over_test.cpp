// Tables change hands without a lock. On a board the tick interrupts the background after any
// machine instruction; here it does so after every single one, and for good measure the background
// also acts after every single instruction of a tick. Whatever happens, the offsets are those of
// the old or of the new tables on the ramp between them, never a mixture, never beyond the slew
// limit.
//
// What the offsets ought to be comes from the independent model of the machine and the formula of
// the ramp. A small compensator (4 knots) keeps the number of instructions in reach; the code is
// the same for every size.

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/firmware/node/single_step.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr std::size_t kAxes = 3;
constexpr std::size_t kPoints = 8;
constexpr int kRampTicks = 24;
constexpr std::int32_t kUnlimited = 1'000'000'000;
constexpr std::int32_t kSlow = 3'000;  // nm per tick: the ramp alone would be faster

// Code that is instrumented or not optimised has ten times the instructions: there only the first
// ones of long work, and only some of a tick.
#ifdef NDEBUG
constexpr std::uint64_t kMostSteps = UINT64_MAX;
constexpr std::uint64_t kStride = 1;
#else
constexpr std::uint64_t kMostSteps = 20'000;
constexpr std::uint64_t kStride = 199;
#endif

using Small = Compensator<LoadedMachine<kAxes>, 4>;
using Offsets = std::array<double, kAxes>;
using Points = std::array<std::array<std::int64_t, kMaxAxes>, kPoints>;
using Wanted = std::array<Offsets, kPoints>;  // at the points, without limits

// Strokes of the XYFZ machine (docs/papers/xyfz.md); the same in both directions, so that no
// history matters.
MachineTables small_tables(std::uint64_t seed) {
  Random random(seed);
  MachineTables tables = xyfz_tables(20e3, 2e-5, random);
  tables.axis[0] = random_table(-500'000'000, 170'000'000, 4, 20e3, 2e-5, random);
  tables.axis[1] = random_table(-300'000'000, 100'000'000, 4, 20e3, 2e-5, random);
  tables.axis[2] = random_table(-400'000'000, 140'000'000, 4, 20e3, 2e-5, random);
  for (AxisTable& t : tables.axis)
    t.value[1] = t.value[0];
  return tables;
}

Points some_points() {
  Random random(17);
  Points points{};
  for (auto& p : points) {
    p[0] = random.integer(-500'000'000, 0);
    p[1] = random.integer(-300'000'000, 0);
    p[2] = random.integer(-400'000'000, 0);
  }
  return points;
}

Wanted wanted_by(const MachineTables& tables, const Points& points) {
  MachineModel model(tables, tables.machine.tool_point);
  Wanted wanted{};
  for (std::size_t p = 0; p < kPoints; ++p) {
    model.stand_at(points[p], {});
    const Real3 error = model.first_order();
    for (std::size_t a = 0; a < kAxes; ++a)
      wanted[p][a] = -static_cast<double>(error[a]);
  }
  return wanted;
}

// s(u) = u³ (10 − 15u + 6u²) after so many ticks (conventions of the ramp in limiter.hpp).
double ramp_after(int ticks) {
  const double u = std::min(1.0, static_cast<double>(ticks) / kRampTicks);
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

// A compensator with a check of every tick.
class JudgedMachine {
 public:
  static constexpr std::uint32_t kA = 0xA;
  static constexpr std::uint32_t kB = 0xB;

  // Where steps are limited the machine stands still, so that offsets arrive where they should.
  explicit JudgedMachine(std::int32_t rate)
      : rate_(rate), points_in_use_(rate < kUnlimited ? 1 : kPoints) {
    auto settings = open_settings<kAxes>();
    settings.ramp_ticks = kRampTicks;
    for (AxisLimits& l : settings.axis)
      l.rate = l.soft_rate = rate;
    EXPECT_TRUE(small.configure(settings).ok());
    for (AxisSample& sample : in_.axis)
      sample.valid = sample.homed = true;
  }

  Status stage(std::uint32_t name) {
    const MachineTables& tables = name == kA ? a_ : b_;
    return small.stage(tables, tool_of(tables.machine), name);
  }
  void activate(std::uint32_t name) {
    EXPECT_TRUE(stage(name).ok());
    EXPECT_TRUE(small.activate().ok());
  }

  // Prepares a tick, runs it, judges it; together, or in parts for a look into the middle.
  void tick() {
    choose_point();
    run();
    judge();
  }
  void choose_point() {
    point_ = (point_ + 1) % points_in_use_;
    for (std::size_t a = 0; a < kAxes; ++a)
      in_.axis[a].position = points_[point_][a];
  }
  void run() { small.tick(in_, out_); }
  void judge() {
    note_change();
    ++since_change_;
    const double s = ramp_after(since_change_);
    for (std::size_t a = 0; a < kAxes; ++a) {
      const double target = shown_ == 0 ? 0.0 : (shown_ == kA ? by_a_ : by_b_)[point_][a];
      const double before = before_[a];
      const double ideal = from_[a] + s * (target - from_[a]);
      const double expected = std::clamp(ideal, before - rate_, before + rate_);
      const double error = std::abs(out_.offset[a] - expected);
      worst_ = std::max(worst_, error);
      if (std::abs(out_.offset[a] - before) > rate_) ++steps_beyond_rate_;
      before_[a] = out_.offset[a];
    }
    ++ticks_;
  }
  void settle() {
    tick();
    for (int i = 0; i < 10'000 && (ramping() || !still()); ++i)
      tick();
  }

  // Half a nanometre of rounding, half of the arithmetic in float (8·2⁻²⁴·S below 1 mm).
  void expect_faultless() const {
    EXPECT_LE(worst_, 1.0) << "nm from both the old and the new tables";
    EXPECT_EQ(steps_beyond_rate_, 0);
    EXPECT_GT(ticks_, 0);
  }
  [[nodiscard]] std::uint32_t shown() const { return shown_; }
  [[nodiscard]] bool ramping() const { return since_change_ < kRampTicks; }

  Small small{LoadedMachine<kAxes>{make_runtime_chain(kXyfzMachine)}};

 private:
  // The tables due next begin with the tick that took them over.
  void note_change() {
    const std::uint32_t now = small.active() ? small.diagnostics().active_crc : 0U;
    const std::uint32_t activations = small.diagnostics().activations;
    if (now == shown_ && activations == activations_) return;
    shown_ = now;
    activations_ = activations;
    since_change_ = 0;
    from_ = before_;
  }
  [[nodiscard]] bool still() const {
    for (std::size_t a = 0; a < kAxes; ++a) {
      const double target = shown_ == 0 ? 0.0 : (shown_ == kA ? by_a_ : by_b_)[point_][a];
      if (std::abs(before_[a] - target) > rate_) return false;
    }
    return true;
  }

  MachineTables a_ = small_tables(1);
  MachineTables b_ = small_tables(2);
  Points points_ = some_points();
  Wanted by_a_ = wanted_by(a_, points_);
  Wanted by_b_ = wanted_by(b_, points_);
  std::int32_t rate_;
  std::size_t points_in_use_;
  Small::Input in_{};
  Small::Output out_{};
  std::size_t point_ = 0;
  std::uint32_t shown_ = 0;  // tables of the last tick, 0: none
  std::uint32_t activations_ = 0;
  int since_change_ = kRampTicks;
  Offsets from_{};
  Offsets before_{};
  double worst_ = 0.0;
  int steps_beyond_rate_ = 0;
  int ticks_ = 0;
};

class JudgedTest : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kA = JudgedMachine::kA;
  static constexpr std::uint32_t kB = JudgedMachine::kB;

  explicit JudgedTest(std::int32_t rate) : machine(rate) {}

  void SetUp() override {
    machine.activate(kA);
    machine.settle();
    ASSERT_EQ(machine.shown(), kA);
  }
  void TearDown() override { machine.expect_faultless(); }

  // The tick after every instruction of the work.
  template <class Work>
  std::uint64_t preempted(Work&& work) {
    return SingleStep::through(work, [&](std::uint64_t done) {
      machine.tick();
      return done < kMostSteps;
    });
  }

  JudgedMachine machine;
};

class LongWork : public JudgedTest {
 protected:
  LongWork() : JudgedTest(kUnlimited) {}
};

class HandOver : public JudgedTest, public ::testing::WithParamInterface<std::int32_t> {
 protected:
  HandOver() : JudgedTest(GetParam()) {}
};

INSTANTIATE_TEST_SUITE_P(SlewLimit, HandOver, ::testing::Values(kUnlimited, kSlow));

// --- the tick between any two instructions of the background

TEST_F(LongWork, WhileTablesAreStagedTheOldOnesGoOn) {
  Status status;
  const std::uint64_t steps = preempted([&] { status = machine.stage(kB); });
  EXPECT_TRUE(status.ok());
  EXPECT_GT(steps, 10'000U);
  EXPECT_EQ(machine.shown(), kA);
  EXPECT_TRUE(machine.small.scrub().ok());
}

TEST_P(HandOver, TablesAreActivatedAtOneInstruction) {
  for (const std::uint32_t next : {kB, kA, kB}) {
    ASSERT_TRUE(machine.stage(next).ok());
    Status status;
    preempted([&] { status = machine.small.activate(); });
    EXPECT_TRUE(status.ok());
    machine.tick();
    EXPECT_EQ(machine.shown(), next);
    machine.settle();
    EXPECT_TRUE(machine.small.scrub().ok());
  }
}

TEST_P(HandOver, CorrectionsAreTakenBackAtOneInstruction) {
  preempted([&] { machine.small.deactivate(); });
  machine.tick();
  EXPECT_EQ(machine.shown(), 0U);
  machine.settle();
  machine.activate(kB);
  machine.settle();
  EXPECT_EQ(machine.shown(), kB);
}

TEST_F(LongWork, ScrubbingDisturbsNothing) {
  Status status;
  EXPECT_GT(preempted([&] { status = machine.small.scrub(); }), 1000U);
  EXPECT_TRUE(status.ok());
  EXPECT_EQ(machine.shown(), kA);
}

// A second change in the middle of the ramp of the first.
TEST_P(HandOver, AChangeDuringARampBeginsWhereTheOffsetsAre) {
  machine.activate(kB);
  for (int i = 0; i < kRampTicks / 2; ++i)
    machine.tick();
  ASSERT_TRUE(machine.ramping());
  ASSERT_TRUE(machine.stage(kA).ok());
  preempted([&] { static_cast<void>(machine.small.activate()); });
  machine.settle();
  EXPECT_EQ(machine.shown(), kA);
}

// --- the background between any two instructions of a tick

class HandOverInATick : public JudgedTest {
 protected:
  HandOverInATick() : JudgedTest(kUnlimited) {}
};

// `act` after the first instruction of a tick, then `restore`; after the next one of another tick
// and so on to the end, `stride` instructions apart.
template <class Act, class Restore>
void between_instructions(JudgedMachine& machine, std::uint64_t stride, const Act& act,
                          const Restore& restore) {
  std::uint64_t most = 0;
  for (std::uint64_t n = 1;; n += stride) {
    machine.choose_point();
    std::uint64_t reached = 0;
    SingleStep::through([&] { machine.run(); },
                        [&](std::uint64_t done) {
                          reached = done;
                          if (done == n) act();
                          return done != n;
                        });
    machine.judge();
    most = std::max(most, reached);
    if (reached < n) break;
    machine.settle();
    restore();
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(most, 200U);
}

TEST_F(HandOverInATick, ActivatingInTheMiddleOfATick) {
  std::uint32_t next = kB;
  ASSERT_TRUE(machine.stage(next).ok());
  between_instructions(
      machine, 5 * kStride, [&] { static_cast<void>(machine.small.activate()); },
      [&] {
        EXPECT_EQ(machine.shown(), next);
        next = next == kA ? kB : kA;
        EXPECT_TRUE(machine.stage(next).ok());
      });
}

TEST_F(HandOverInATick, TakingCorrectionsBackInTheMiddleOfATick) {
  between_instructions(
      machine, 11 * kStride, [&] { machine.small.deactivate(); },
      [&] {
        EXPECT_EQ(machine.shown(), 0U);
        machine.activate(kA);
        machine.settle();
      });
}

// The tick that takes tables over makes the old ones the spare: they may be overwritten at once.
TEST_F(HandOverInATick, StagingInTheMiddleOfTheTickThatTakesOver) {
  std::uint32_t next = kB;
  machine.activate(next);
  between_instructions(
      machine, 9 * kStride,
      [&] {
        // Refused while the hand-over is pending, otherwise the third set.
        static_cast<void>(machine.stage(next == kA ? kB : kA));
      },
      [&] {
        EXPECT_EQ(machine.shown(), next);
        EXPECT_TRUE(machine.small.scrub().ok());
        next = next == kA ? kB : kA;
        machine.activate(next);
      });
}

}  // namespace
}  // namespace volcomp::test
