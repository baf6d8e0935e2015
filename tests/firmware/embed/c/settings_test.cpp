// Settings of volcomp.h from seconds: the same machine at any period of its tick.

#include "tests/firmware/embed/c/support.hpp"
#include "tests/not_numbers.hpp"

namespace volcomp::test {
namespace {

// 0.2 m/s² are 200 nm per ms and ms; 2 rad/s² are 1367.1 parts of 2^-32 turn.
TEST(CInterfaceSettings, AccelerationFromSeconds) {
  volcomp_axis_limits l{};
  const auto of = [&l](bool rotary, double acceleration, double period_s) {
    EXPECT_EQ(text(volcomp_set_acceleration(&l, rotary, acceleration, period_s)), "ok");
    return l.acceleration;
  };
  EXPECT_EQ(of(false, 0.2, 1e-3), 200);
  EXPECT_EQ(of(false, 0.2, 250e-6), 12);
  EXPECT_EQ(of(false, 0.2, 125e-6), 3);
  EXPECT_EQ(of(true, 2.0, 1e-3), 1367);
  EXPECT_EQ(text(volcomp_set_acceleration(&l, false, 0.2, 62.5e-6)),
            "acceleration_too_small acceleration");
  EXPECT_EQ(text(volcomp_set_acceleration(&l, false, -0.1, 1e-3)), "bad_setting acceleration");
  EXPECT_EQ(text(volcomp_set_acceleration(&l, false, kNan, 1e-3)), "bad_setting acceleration");
  EXPECT_EQ(text(volcomp_set_acceleration(&l, false, 0.2, 0.0)), "bad_setting period");
  EXPECT_EQ(text(volcomp_set_acceleration(nullptr, false, 0.2, 1e-3)), "null_pointer limits");
  EXPECT_EQ(l.acceleration, 1367) << "as before";
  EXPECT_EQ(of(false, 0.0, 1e-3), 0);
}

// Design of the limiter, section 2: v = min(rate, a + D_a(limit / 2)). From d = a + D_a(x) stopping
// takes x beyond the step itself: at 200 per tick and tick 6 225 + 6 025 + … ≤ 100 000 < 6 226 + ….
TEST(CInterfaceSettings, EffectiveRateLeavesRoomToStop) {
  volcomp_axis_limits l{200'000, 10'000, 1'000, 0, 0, 200};
  EXPECT_EQ(volcomp_effective_rate(&l), 6'425);
  const auto way_of = [](std::int32_t d, std::int32_t a) {
    std::int32_t way = 0;
    for (d -= a; d > 0; d -= a)
      way += d;
    return way;
  };
  EXPECT_LE(way_of(6'425, 200), 100'000);
  EXPECT_GT(way_of(6'426, 200), 100'000);
  l.rate = 6'000;
  EXPECT_EQ(volcomp_effective_rate(&l), 6'000) << "as stated";
  l.acceleration = 0;
  l.rate = 10'000;
  EXPECT_EQ(volcomp_effective_rate(&l), 10'000) << "no bound";
  l.limit = 0;
  EXPECT_EQ(volcomp_effective_rate(&l), 0) << "refused";
  EXPECT_EQ(volcomp_effective_rate(nullptr), 0);
}

// 10 000 nm per tick are 10 mm/s at 1 ms and 80 mm/s at 125 µs.
TEST(CInterfaceSettings, RatesFromSeconds) {
  volcomp_axis_limits l{};
  const auto of = [&l](bool rotary, double rate, double soft_rate, double period_s) {
    EXPECT_EQ(text(volcomp_set_rate(&l, rotary, rate, soft_rate, period_s)), "ok");
    return std::array<std::int32_t, 2>{l.rate, l.soft_rate};
  };
  using Pair = std::array<std::int32_t, 2>;
  EXPECT_EQ(of(false, 10.0, 1.0, 1e-3), (Pair{10'000, 1'000}));
  EXPECT_EQ(of(false, 10.0, 1.0, 125e-6), (Pair{1'250, 125}));
  EXPECT_EQ(of(false, 80.0, 80.0, 125e-6), (Pair{10'000, 10'000}));
  EXPECT_EQ(of(true, 0.1, 0.005, 1e-3), (Pair{68'356, 3'417}));
  const auto refused = [&l](double rate, double soft_rate, double period_s) {
    return text(volcomp_set_rate(&l, false, rate, soft_rate, period_s));
  };
  EXPECT_EQ(refused(0.0, 1.0, 1e-3), "bad_setting rate");
  EXPECT_EQ(refused(kNan, 1.0, 1e-3), "bad_setting rate");
  EXPECT_EQ(refused(1.1e6, 1.0, 1e0), "bad_setting rate");
  EXPECT_EQ(refused(10.0, 11.0, 1e-3), "bad_setting soft_rate");
  EXPECT_EQ(refused(10.0, 9e-4, 1e-3), "bad_setting soft_rate");
  EXPECT_EQ(refused(10.0, kNan, 1e-3), "bad_setting soft_rate");
  EXPECT_EQ(refused(10.0, 1.0, 2.0), "bad_setting period");
  EXPECT_EQ(text(volcomp_set_rate(nullptr, false, 10.0, 1.0, 1e-3)), "null_pointer limits");
  EXPECT_EQ(l.rate, 68'356) << "as before";
  EXPECT_EQ(l.soft_rate, 3'417) << "as before";
}

// 0.25 m/s move by 50 µm in 0.2 ms; twice that is still plausible.
TEST(CInterfaceSettings, PlausibleStepsFromSeconds) {
  volcomp_axis_limits l{};
  const auto of = [&l](bool rotary, double speed, double period_s) {
    EXPECT_EQ(text(volcomp_set_max_speed(&l, rotary, speed, period_s)), "ok");
    return l.max_step;
  };
  EXPECT_EQ(of(false, 250.0, 200e-6), 100'000);
  EXPECT_EQ(of(false, 500.0, 125e-6), 125'000);
  EXPECT_EQ(of(true, kPi, 1.0 / 1024.0), VOLCOMP_UNITS_PER_TURN / 1024);
  EXPECT_EQ(of(false, 5e8, 1.0), kMaxPosition) << "held where positions are";
  EXPECT_EQ(text(volcomp_set_max_speed(&l, false, 1e-4, 1e-3)), "bad_setting max_speed");
  EXPECT_EQ(text(volcomp_set_max_speed(&l, false, -1.0, 1e-3)), "bad_setting max_speed");
  EXPECT_EQ(text(volcomp_set_max_speed(&l, false, kNan, 1e-3)), "bad_setting max_speed");
  EXPECT_EQ(text(volcomp_set_max_speed(&l, false, 1.0, kNan)), "bad_setting period");
  EXPECT_EQ(text(volcomp_set_max_speed(nullptr, false, 1.0, 1e-3)), "null_pointer limits");
  EXPECT_EQ(l.max_step, kMaxPosition) << "as before";
  EXPECT_EQ(of(false, 0.0, 1e-3), 0) << "any";
}

TEST(CInterfaceSettings, TimesFromSeconds) {
  volcomp_settings s{};
  volcomp_default_settings(&s);
  const auto of = [&s](double ramp_s, double stale_drop_s, double period_s) {
    EXPECT_EQ(text(volcomp_set_times(&s, ramp_s, stale_drop_s, period_s)), "ok");
    return std::array<std::uint32_t, 2>{s.ramp_ticks, s.stale_drop_ticks};
  };
  using Pair = std::array<std::uint32_t, 2>;
  EXPECT_EQ(of(0.2, 0.01, 1e-3), (Pair{200, 10}));
  EXPECT_EQ(of(0.2, 0.01, 125e-6), (Pair{1'600, 80}));
  EXPECT_EQ(of(0.2, 0.01, 62.5e-6), (Pair{3'200, 160}));
  EXPECT_EQ(of(0.0, 0.0, 1e-3), (Pair{1, 0})) << "at once";
  EXPECT_EQ(of(0.4, 0.004, 200e-6), (Pair{2'000, 20}));
  EXPECT_EQ(text(volcomp_set_times(&s, -1.0, 0.01, 1e-3)), "bad_setting ramp");
  EXPECT_EQ(text(volcomp_set_times(&s, 1.7e4, 0.01, 1e-3)), "bad_setting ramp");
  EXPECT_EQ(text(volcomp_set_times(&s, 0.2, 65.6, 1e-3)), "bad_setting stale_drop");
  EXPECT_EQ(text(volcomp_set_times(&s, 0.2, kNan, 1e-3)), "bad_setting stale_drop");
  EXPECT_EQ(text(volcomp_set_times(&s, 0.2, 0.01, -1e-3)), "bad_setting period");
  EXPECT_EQ(text(volcomp_set_times(nullptr, 0.2, 0.01, 1e-3)), "null_pointer settings");
  EXPECT_EQ(s.ramp_ticks, 2'000U) << "as before";
  EXPECT_EQ(s.stale_drop_ticks, 20U) << "as before";
}

// Whatever the functions accept, a compensator takes.
TEST(CInterfaceSettings, WhatIsSetIsTaken) {
  CInstance c;
  for (const double period_s : {1e-3, 250e-6, 125e-6}) {
    volcomp_settings s{};
    volcomp_default_settings(&s);
    EXPECT_EQ(text(volcomp_set_times(&s, 0.2, 0.01, period_s)), "ok");
    for (std::size_t a = 0; a < VOLCOMP_AXES; ++a) {
      const bool rotary = a >= 3;
      volcomp_axis_limits& l = s.axis[a];
      EXPECT_EQ(
          text(volcomp_set_rate(&l, rotary, rotary ? 0.1 : 10.0, rotary ? 5e-3 : 1.0, period_s)),
          "ok");
      EXPECT_EQ(text(volcomp_set_acceleration(&l, rotary, rotary ? 2.0 : 0.2, period_s)), "ok");
      EXPECT_EQ(text(volcomp_set_max_speed(&l, rotary, rotary ? 1.0 : 500.0, period_s)), "ok");
    }
    EXPECT_EQ(text(volcomp_configure(c.get(), &s)), "ok") << period_s;
  }
}

}  // namespace
}  // namespace volcomp::test
