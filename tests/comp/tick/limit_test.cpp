// What leaves the tick is finite and within its limit, whatever the memory of the tables holds and
// whenever the limits change.

#include "tests/comp/tick/overwrite.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr float kError = 12'345.5F;  // nm; nothing else in a compensator has these bits

template <class AnyRunner>
void expect_let_go(AnyRunner& runner, float bad) {
  auto settings = open_settings<std::decay_t<decltype(*runner.compensator)>::kAxes>();
  for (AxisLimits& l : settings.axis) {
    l.limit = 200'000;
    l.rate = 10'000;
    l.soft_rate = 1'000;
  }
  const MachineTables tables = constant_tables(kError);
  ASSERT_TRUE(runner.start(tables, settings).ok());
  std::int64_t position = -50'000'000;
  const auto move = [&] {  // the fast path: all directions are known
    position += 5'000;
    for (AxisSample& sample : runner.in.axis)
      sample.position = position;
    return runner.tick().offset[0];
  };
  for (int n = 0; n < 20; ++n)
    move();
  const std::int32_t before = runner.out.offset[0];
  ASSERT_EQ(std::abs(before), 12'346);
  ASSERT_EQ(runner.out.status[0], kValid);
  const float folded = -kError;  // X carries the workpiece
  ASSERT_GT(overwrite(*runner.compensator, folded, bad), 0);
  std::int32_t last = before;
  for (int n = 0; n < 20; ++n) {
    const std::int32_t now = move();
    ASSERT_LE(std::abs(now - last), 1'000) << "tick " << n;
    ASSERT_LE(std::abs(now), std::abs(last)) << "tick " << n;
    ASSERT_EQ(runner.out.status[0] & kValid, 0) << "tick " << n;
    ASSERT_EQ(runner.out.status[0] & (kClamped | kTableDamaged), kClamped | kTableDamaged);
    ASSERT_EQ(runner.out.status[1], kValid) << "the others go on";
    last = now;
  }
  EXPECT_EQ(last, 0);
  EXPECT_GT(runner.compensator->diagnostics().began[0][bit_of(kTableDamaged)], 0);
}

constexpr std::array<float, 3> kNotFinite{std::numeric_limits<float>::quiet_NaN(),
                                          std::numeric_limits<float>::infinity(),
                                          -std::numeric_limits<float>::infinity()};

TEST(Limit, WhatIsNotFiniteGoesToZeroAtTheSoftRate) {
  for (const float bad : kNotFinite) {
    SCOPED_TRACE(static_cast<double>(bad));
    LoadedRunner loaded(kXyfzMachine);
    expect_let_go(loaded, bad);
    XyfzRunner compiled;
    expect_let_go(compiled, bad);
    OrientingRunner orienting(kXyfzMachine);
    expect_let_go(orienting, bad);
  }
}

// IEEE 754: every comparison with NaN is false. It must not pass for being within a limit.
TEST(Limit, WhatIsNotFiniteExceedsEveryLimit) {
  for (const float bad : kNotFinite) {
    EXPECT_FALSE(Magnitude::finite(bad));
    EXPECT_TRUE(exceeds(bad, Magnitude(5.0F)));
  }
  EXPECT_TRUE(exceeds(kNotFinite[0], Magnitude(kNotFinite[1]))) << "whatever the limit is";
}

// Random settings, tables and samples; every tick is compared with what the settings promise.
class Shrinking {
 public:
  explicit Shrinking(std::uint64_t seed) : random_(seed), runner_(kXyfzMachine) {
    one_ = xyfz_tables(60e3, 8e-5, random_);
    other_ = xyfz_tables(60e3, 8e-5, random_);
  }

  void run(int ticks) {
    SCOPED_TRACE(random_.trace());
    configure();
    for (int n = 0; n < ticks && !::testing::Test::HasFatalFailure(); ++n) {
      events();
      tick(n);
    }
  }
  [[nodiscard]] int beyond() const { return beyond_; }

 private:
  void configure() {
    for (AxisLimits& l : settings_.axis) {
      l.limit = static_cast<std::int32_t>(random_.integer(1, 100'000));
      l.rate = static_cast<std::int32_t>(random_.integer(1, 20'000));
      l.soft_rate = static_cast<std::int32_t>(random_.integer(1, l.rate));
    }
    settings_.source = random_.chance(0.5) ? PositionSource::target : PositionSource::actual;
    settings_.ramp_ticks = static_cast<std::uint32_t>(random_.integer(1, 300));
    ASSERT_TRUE(runner_.compensator->configure(settings_).ok());
  }

  void events() {
    if (random_.chance(0.01)) configure();
    if (random_.chance(0.01)) {
      const MachineTables& next = random_.chance(0.5) ? one_ : other_;
      const bool staged = runner_.compensator->stage(next, Vec3::Zero(), 0).ok();
      if (staged && random_.chance(0.8)) {
        ASSERT_TRUE(runner_.compensator->activate().ok());
      }
    }
    if (random_.chance(0.003)) runner_.compensator->deactivate();
    if (random_.chance(0.002)) {
      for (std::size_t a = 0; a < 3; ++a)
        last_[a] = static_cast<std::int32_t>(random_.integer(-300'000, 300'000));
      ASSERT_TRUE(runner_.compensator->start_from(last_).ok());
    }
    for (std::size_t a = 0; a < 3; ++a) {
      AxisSample& s = runner_.in.axis[a];
      s.valid = s.valid ? !random_.chance(0.005) : random_.chance(0.1);
      s.homed = s.homed ? !random_.chance(0.002) : random_.chance(0.05);
      s.position = random_.integer(-500'000'000, 0);
    }
  }

  void tick(int n) {
    runner_.tick();
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t limit = settings_.axis[a].limit;
      const std::int32_t was = std::abs(last_[a]);
      const std::int32_t now = std::abs(runner_.out.offset[a]);
      ASSERT_LE(std::abs(runner_.out.offset[a] - last_[a]), settings_.axis[a].rate) << n;
      ASSERT_LE(now, std::max(was, limit)) << "tick " << n << " axis " << a;
      if (was > limit) {
        ASSERT_GE(was - now, std::min(was - limit, settings_.axis[a].soft_rate))
            << "tick " << n << " axis " << a;
      }
      if (now > limit) {
        ++beyond_;
        ASSERT_EQ(runner_.out.status[a] & kValid, 0) << "tick " << n << " axis " << a;
        ASSERT_EQ(runner_.out.status[a] & (kClamped | kRateLimited), kClamped | kRateLimited);
      }
      last_[a] = runner_.out.offset[a];
    }
  }

  Random random_;
  LoadedRunner runner_;
  MachineTables one_;
  MachineTables other_;
  CompensatorSettings<5> settings_{};
  std::array<std::int32_t, 5> last_{};
  int beyond_ = 0;
};

TEST(Limit, ASmallerOneIsApproachedAtTheRateAndNeverLeftBehind) {
  int beyond = 0;
  for (std::uint64_t round = 0; round < 10; ++round) {
    Shrinking shrinking(300 + round);
    shrinking.run(std::max(kManyPoints / 40, 2'500));
    beyond += shrinking.beyond();
  }
  EXPECT_GT(beyond, 100) << "no limit was ever smaller than an offset";
}

// In a quiet moment as in a ramp: what the ramp began with is no longer where it goes back to.
TEST(Limit, ASmallerOneHoldsDuringARamp) {
  LoadedRunner runner(kXyfzMachine);
  auto settings = open_settings<5>();
  settings.ramp_ticks = 200;
  ASSERT_TRUE(runner.start(constant_tables(100'000.0F), settings).ok());
  for (int n = 0; n < 250; ++n)
    runner.tick({});
  ASSERT_EQ(runner.out.offset[0], 100'000);
  ASSERT_TRUE(runner.swap(constant_tables(90'000.0F)).ok());
  runner.tick({});
  settings.axis[0].limit = 30'000;
  settings.axis[0].rate = settings.axis[0].soft_rate = 10'000;
  ASSERT_TRUE(runner.compensator->configure(settings).ok());
  for (int n = 0; n < 7; ++n)
    runner.tick({});
  EXPECT_EQ(runner.out.offset[0], 30'000);
}

}  // namespace
}  // namespace volcomp::test
