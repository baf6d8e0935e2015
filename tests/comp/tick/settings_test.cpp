// Every bad setting is refused with its field and axis, and changes nothing.

#include <algorithm>
#include <cstring>

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

using Settings = CompensatorSettings<5>;

void expect_refused(const Settings& settings, const char* field, int axis) {
  LoadedRunner runner(kXyfzMachine);
  const Status status = runner.compensator->configure(settings);
  ASSERT_EQ(status.reason, Reason::bad_setting) << field;
  ASSERT_NE(status.where.field, nullptr);
  EXPECT_STREQ(status.where.field, field);
  EXPECT_EQ(status.where.index, axis) << field;
  if (axis >= 0) {
    EXPECT_EQ(status.where.axis, "XYZ"[axis]) << field;
  }
}

TEST(Settings, DefaultsAreAccepted) {
  LoadedRunner runner(kXyfzMachine);
  EXPECT_TRUE(runner.compensator->configure({}).ok());
}

TEST(Settings, LimitsAreInclusive) {
  LoadedRunner runner(kXyfzMachine);
  Settings s;
  s.axis[0] = {{1, 1, 1, 0}, 0, 0};
  s.axis[1] = {{4'194'303, 1'000'000'000, 1'000'000'000, 16'777'216},
               4'194'303,
               std::numeric_limits<std::int64_t>::max()};
  s.ramp_ticks = 1;
  s.stale_drop_ticks = 0;
  EXPECT_TRUE(runner.compensator->configure(s).ok());
}

TEST(Settings, EachFieldOfEachAxisIsChecked) {
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  using List = std::initializer_list<std::int32_t>;  // int32 is not int on every target
  for (int axis = 0; axis < 3; ++axis) {
    const auto with = [axis](auto&& change) {
      Settings s;
      change(s.axis[static_cast<std::size_t>(axis)]);
      return s;
    };
    for (const std::int32_t limit : List{0, -1, kLeast, 4'194'304})
      expect_refused(with([=](AxisLimits& l) { l.limit = limit; }), "limit", axis);
    for (const std::int32_t rate : List{0, -1, kLeast, 1'000'000'001})
      expect_refused(with([=](AxisLimits& l) {
                       l.rate = rate;
                       l.soft_rate = rate > 0 ? 1 : rate;
                     }),
                     "rate", axis);
    for (const std::int32_t soft : List{0, -1, kLeast, 10'001})
      expect_refused(with([=](AxisLimits& l) { l.soft_rate = soft; }), "soft_rate", axis);
    for (const std::int32_t acceleration : List{-1, kLeast, 16'777'217})
      expect_refused(with([=](AxisLimits& l) {
                       l.rate = 1'000'000'000;
                       l.acceleration = acceleration;
                     }),
                     "acceleration", axis);
    for (const std::int32_t hysteresis : List{-1, kLeast, 4'194'304})
      expect_refused(with([=](AxisLimits& l) { l.hysteresis = hysteresis; }), "hysteresis", axis);
    for (const std::int64_t step : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::min()})
      expect_refused(with([=](AxisLimits& l) { l.max_step = step; }), "max_step", axis);
  }
  Settings s;
  s.ramp_ticks = 0;
  expect_refused(s, "ramp_ticks", -1);
}

TEST(Settings, ARefusalLeavesTheOldOnesInForce) {
  LoadedRunner runner(kXyfzMachine);
  auto good = open_settings<5>();
  good.axis[0].limit = 1'234;
  ASSERT_TRUE(runner.start(constant_tables(50'000.0F), good).ok());
  EXPECT_EQ(runner.tick({0, 0, 0, 0, 0}).offset[0], 1'234);
  EXPECT_NE(runner.out.status[0] & kClamped, 0);
  EXPECT_EQ(runner.out.status[1] & kClamped, 0);
  auto bad = open_settings<5>();  // limit 4.19 mm …
  bad.axis[2].rate = 0;           // … but refused
  bad.axis[2].soft_rate = 0;
  ASSERT_FALSE(runner.compensator->configure(bad).ok());
  EXPECT_EQ(runner.tick().offset[0], 1'234);
}

// The clamp is exact on both sides and not reported when just reached.
TEST(Settings, ClampIsExact) {
  for (const float x : {-50'000.0F, 50'000.0F, 1'999.0F, 2'000.0F, -2'000.0F, 2'001.0F}) {
    MachineTables tables;
    tables.machine = kXyfzMachine;
    for (std::size_t a = 0; a < 3; ++a) {
      tables.axis[a].pitch = 100'000'000;
      tables.axis[a].knots = 2;
    }
    for (auto& column : tables.axis[0].value)
      column[0][0] = column[1][0] = x;
    LoadedRunner runner(kXyfzMachine);
    auto settings = open_settings<5>();
    settings.axis[0].limit = 2'000;
    ASSERT_TRUE(runner.start(tables, settings).ok());
    runner.tick({0, 0, 0, 0, 0});
    const auto want = static_cast<std::int32_t>(x);
    EXPECT_EQ(runner.out.offset[0], std::clamp<std::int32_t>(want, -2'000, 2'000));
    EXPECT_EQ((runner.out.status[0] & kClamped) != 0, std::abs(want) > 2'000) << want;
  }
}

}  // namespace
}  // namespace volcomp::test
