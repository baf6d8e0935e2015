// The filter of a trace and the run-out of a gear: what must come out of simple ones, and refusals.

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "comp/metrology/gears/run_out.hpp"
#include "comp/metrology/gears/trace_filter.hpp"

namespace volcomp {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(TraceFilter, KeepsAStraightLineUpToItsEnds) {
  std::array<double, 40> at{};
  std::array<double, 40> line{};
  std::array<double, 40> out{};
  for (std::size_t i = 0; i < at.size(); ++i) {
    at[i] = std::pow(static_cast<double>(i), 1.2);  // unevenly spaced
    line[i] = 3.0 - 0.25 * at[i];
  }
  ASSERT_TRUE(filter_trace(at, line, 10.0, FilterOrder::line, out).ok());
  for (std::size_t i = 0; i < at.size(); ++i)
    EXPECT_NEAR(out[i], line[i], 1e-11) << i;
}

TEST(TraceFilter, HalvesAWaveOfTheCutOff) {
  std::array<double, 801> at{};
  std::array<double, 801> wave{};
  std::array<double, 801> out{};
  for (std::size_t i = 0; i < at.size(); ++i) {
    at[i] = 0.01 * static_cast<double>(i);
    wave[i] = std::cos(2.0 * kPi * at[i]);
  }
  ASSERT_TRUE(filter_trace(at, wave, 1.0, FilterOrder::line, out).ok());
  EXPECT_NEAR(out[400], 0.5, 1e-6);
}

TEST(TraceFilter, Refuses) {
  std::array<double, 4> at{0.0, 1.0, 2.0, 3.0};
  std::array<double, 4> f{};
  std::array<double, 4> out{};
  const auto reason = [&] { return filter_trace(at, f, 1.0, FilterOrder::line, out).reason; };
  EXPECT_EQ(filter_trace(at, f, 0.0, FilterOrder::line, out).reason, Reason::bad_setting);
  EXPECT_EQ(
      filter_trace({at.data(), 2}, {f.data(), 2}, 1.0, FilterOrder::line, {out.data(), 2}).reason,
      Reason::too_few_points);
  EXPECT_EQ(filter_trace({at.data(), 3}, f, 1.0, FilterOrder::line, out).reason,
            Reason::length_mismatch);
  at[2] = 1.0;
  EXPECT_EQ(reason(), Reason::positions_not_monotone);
  f[1] = kNaN;
  EXPECT_EQ(reason(), Reason::not_finite);
}

constexpr BallInSpace kBall{31, 3.0, 20.0 * kPi / 180.0, 0.0, 0.0, 5.25};

// A gear whose teeth lie on a circle beside its bore: along the line of action the flanks of a
// space are off by e sin α in the direction of the space, and a ball comes to lie off by e.
TEST(RunOut, OfAnEccentricGearIsTwiceTheEccentricity) {
  constexpr double kEccentricity = 0.01;
  BallSeat seat;
  ASSERT_TRUE(ball_seat(kBall, seat).ok());
  std::array<double, 31> flank{};
  std::array<double, 31> radial{};
  for (std::size_t k = 0; k < flank.size(); ++k)
    flank[k] = kEccentricity * std::sin(seat.pressure_angle) *
               std::cos(2.0 * kPi * static_cast<double>(k) / 31.0);
  RunOut r;
  ASSERT_TRUE(run_out(kBall, flank, flank, radial, r).ok());
  EXPECT_NEAR(r.eccentricity, kEccentricity, 1e-12);
  EXPECT_NEAR(r.total, 2.0 * kEccentricity, 1e-4);
}

TEST(RunOut, Refuses) {
  const auto reason = [](const BallInSpace& ball) {
    BallSeat seat;
    return ball_seat(ball, seat).reason;
  };
  const auto with = [](auto member, auto value) {
    BallInSpace ball = kBall;
    ball.*member = value;
    return ball;
  };
  EXPECT_EQ(reason(with(&BallInSpace::teeth, 0)), Reason::bad_setting);
  EXPECT_EQ(reason(with(&BallInSpace::module, 0.0)), Reason::bad_setting);
  EXPECT_EQ(reason(with(&BallInSpace::pressure_angle, kNaN)), Reason::bad_setting);
  EXPECT_EQ(reason(with(&BallInSpace::helix_angle, 2.0)), Reason::bad_setting);
  EXPECT_EQ(reason(with(&BallInSpace::shift, kNaN)), Reason::bad_setting);
  EXPECT_EQ(reason(with(&BallInSpace::diameter, -1.0)), Reason::bad_setting);
  EXPECT_EQ(reason(with(&BallInSpace::diameter, 0.1)), Reason::out_of_reach) << "it falls through";
  std::array<double, 31> flank{};
  std::array<double, 31> radial{};
  RunOut r;
  EXPECT_EQ(run_out(kBall, {flank.data(), 30}, flank, radial, r).where.count, 30);
  EXPECT_EQ(run_out(kBall, flank, flank, {radial.data(), 30}, r).reason, Reason::length_mismatch);
  flank[5] = kNaN;
  EXPECT_EQ(run_out(kBall, flank, flank, radial, r).where.index, 5);
}

}  // namespace
}  // namespace volcomp
