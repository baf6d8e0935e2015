// The promise of limit, rate and acceleration through the whole compensator: what comes to pass in
// its memory, the one beginning that jumps, and the compensator without a bound on acceleration.
// volcomp_tick_soak does the rest: exchange, ramps, stale and hostile input, settings in motion.

#include "tests/oracle/offset_promise.hpp"
#include "tests/comp/tick/overwrite.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

using RateAlone = Compensator<CompiledMachine<kXyfzMachine>, kDefaultKnots, OffsetLimiter<false>>;

constexpr float kError = 12'345.5F;  // nm; nothing else in a compensator has these bits

// 10 and 1 mm/s, 0.2 m/s² at 1 ms.
template <class AnyRunner>
auto limited_settings(const AnyRunner& runner, std::int32_t acceleration) {
  auto settings = open_settings<std::decay_t<decltype(*runner.compensator)>::kAxes>();
  for (AxisLimits& l : settings.axis)
    static_cast<OffsetLimits&>(l) = {200'000, 10'000, 1'000, acceleration};
  return settings;
}

// Moves one axis at a time and judges every tick.
template <class AnyRunner>
class Watched {
 public:
  using Unit = std::decay_t<decltype(*std::declval<AnyRunner>().compensator)>;

  explicit Watched(AnyRunner& runner) : runner_(runner) {}

  void configure(const typename Unit::Settings& settings) {
    ASSERT_TRUE(runner_.compensator->configure(settings).ok());
    promise.configured(settings);
  }
  void tick(std::int64_t moved) {
    position_ += moved;
    for (AxisSample& sample : runner_.in.axis)
      sample.position = position_;
    runner_.tick();
    std::size_t axis = 0;
    const char* const broken = promise.offsets_broken_by(*runner_.compensator, runner_.out, axis);
    ASSERT_STREQ(broken, nullptr) << "axis " << axis << " offset " << runner_.out.offset[axis];
  }
  void ticks(int n, std::int64_t moved = 5'000) {
    for (int i = 0; i < n && !::testing::Test::HasFatalFailure(); ++i)
      tick(moved);
  }
  [[nodiscard]] std::int32_t offset() const { return runner_.out.offset[0]; }
  [[nodiscard]] std::uint32_t status() const { return runner_.out.status[0]; }

  OffsetPromise<Unit> promise{};

 private:
  AnyRunner& runner_;
  std::int64_t position_ = -50'000'000;
};

// In full motion, before the offset is reached, and at rest.
template <class AnyRunner>
void expect_braked(AnyRunner& runner, float bad, int ticks_before) {
  Watched<AnyRunner> watched(runner);
  watched.configure(limited_settings(runner, 200));
  ASSERT_TRUE(runner.swap(constant_tables(kError)).ok());
  watched.ticks(ticks_before);
  ASSERT_GT(overwrite(*runner.compensator, -kError, bad), 0);
  watched.ticks(100);
  EXPECT_EQ(watched.offset(), 0);
  EXPECT_NE(watched.status() & kTableDamaged, 0U);
}

TEST(CompensatorPromise, WhatIsNotFiniteInTablesIsBraked) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    for (const int ticks_before : {3, 7, 12, 100}) {
      LoadedRunner loaded(kXyfzMachine);
      expect_braked(loaded, bad, ticks_before);
      XyfzRunner compiled;
      expect_braked(compiled, bad, ticks_before);
      OrientingRunner orienting(kXyfzMachine);
      expect_braked(orienting, bad, ticks_before);
    }
  }
}

// Every way to lose an axis while its offset is on its way: nothing stops within a tick.
TEST(CompensatorPromise, HoldingDroppingAndComingBackBrake) {
  for (int ticks_before = 1; ticks_before < 25; ++ticks_before) {
    XyfzRunner runner;
    Watched<XyfzRunner> watched(runner);
    watched.configure(limited_settings(runner, 200));
    ASSERT_TRUE(runner.swap(constant_tables(kError)).ok());
    watched.ticks(ticks_before);
    runner.in.axis[0].valid = false;
    watched.ticks(40);
    runner.in.axis[0].valid = true;
    watched.ticks(5);
    runner.in.axis[0].homed = false;
    watched.ticks(5);
    runner.in.axis[0].homed = true;
    watched.ticks(5);
    runner.compensator->deactivate();
    watched.ticks(3);
    ASSERT_TRUE(runner.swap(constant_tables(-kError)).ok());
    watched.ticks(100);
    EXPECT_EQ(watched.offset(), -12'346);
    EXPECT_EQ(watched.status(), kValid);
  }
}

TEST(CompensatorPromise, LimitsChangeInMotion) {
  for (int ticks_before = 1; ticks_before < 25; ++ticks_before) {
    LoadedRunner runner(kXyfzMachine);
    Watched<LoadedRunner> watched(runner);
    watched.configure(limited_settings(runner, 200));
    ASSERT_TRUE(runner.swap(constant_tables(kError)).ok());
    watched.ticks(ticks_before);
    auto narrow = limited_settings(runner, 7);
    narrow.axis[0].limit = 5'000;
    narrow.axis[0].rate = narrow.axis[0].soft_rate = 150;
    watched.configure(narrow);
    watched.ticks(200);
    EXPECT_EQ(watched.offset(), 5'000) << "walked in";
    watched.configure(limited_settings(runner, 0));
    watched.ticks(5);
    EXPECT_EQ(watched.offset(), 12'346);
  }
}

// The offset that a drive holds at start-up, and the drive that takes none.
TEST(CompensatorPromise, OnlyABeginningJumps) {
  LoadedRunner runner(kXyfzMachine);
  Watched<LoadedRunner> watched(runner);
  watched.configure(limited_settings(runner, 200));
  ASSERT_TRUE(runner.compensator->start_from({1 << 30, 250'000, -9, 0, 0}).ok());
  watched.promise.started({1 << 30, 250'000, -9, 0, 0});
  ASSERT_TRUE(runner.swap(constant_tables(kError)).ok());
  watched.ticks(20);
  runner.compensator->begin_at_zero(0);
  watched.promise.started_at_zero(0);
  watched.ticks(1);
  EXPECT_LE(std::abs(watched.offset()), 200);
  watched.ticks(300);
  EXPECT_EQ(watched.offset(), 12'346);
}

// A compensator without the code for it: bits as with no acceleration, and none can be set.
TEST(CompensatorPromise, CompiledOutIsTheSameAsNone) {
  Random random(41);
  SCOPED_TRACE(random.trace());
  XyfzRunner with;
  Runner<RateAlone> without;
  const MachineTables one = xyfz_tables(60e3, 1e-4, random);
  const MachineTables other = xyfz_tables(60e3, 1e-4, random);
  auto settings = limited_settings(with, 0);
  settings.ramp_ticks = 50;
  ASSERT_TRUE(with.start(one, settings).ok());
  ASSERT_TRUE(without.start(one, settings).ok());
  for (int n = 0; n < kManyPoints / 20; ++n) {
    if (random.chance(0.01)) {
      settings.axis[0].limit = static_cast<std::int32_t>(random.integer(1, 100'000));
      settings.axis[1].rate = static_cast<std::int32_t>(random.integer(1'000, 20'000));
      ASSERT_TRUE(with.compensator->configure(settings).ok());
      ASSERT_TRUE(without.compensator->configure(settings).ok());
    }
    if (random.chance(0.01)) {
      const MachineTables& next = random.chance(0.5) ? one : other;
      ASSERT_EQ(with.swap(next).ok(), without.swap(next).ok());
    }
    for (std::size_t a = 0; a < 3; ++a) {
      AxisSample& s = with.in.axis[a];
      s = {random.integer(-500'000'000, 0), random.chance(0.98), random.chance(0.98)};
      without.in.axis[a] = s;
    }
    with.tick();
    without.tick();
    ASSERT_EQ(with.out.offset, without.out.offset) << n;
    ASSERT_EQ(with.out.status, without.out.status) << n;
  }
  settings.axis[1].acceleration = 1;
  const Status refused = without.compensator->configure(settings);
  EXPECT_EQ(refused.reason, Reason::bad_setting);
  EXPECT_STREQ(refused.where.field, "acceleration");
  EXPECT_EQ(refused.where.index, 1);
}

}  // namespace
}  // namespace volcomp::test
