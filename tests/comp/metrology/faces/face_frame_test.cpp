// Frames of face gears from many touches: what layouts show, and what is refused.

#include "comp/metrology/faces/face_frame.hpp"

#include <limits>

#include "tests/oracle/face_gears.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

using Points = std::vector<FaceTouchPoint>;

class FaceFrameTest : public ::testing::Test {
 protected:
  FaceFrameTest() {
    settings.freedom = FrameFreedom::all;
    settings.ball_radius = 0.5;
  }

  void add(Points& points, int side, int slot, std::size_t row, std::size_t column) const {
    const FaceFlank flank = flank_of(gear, side, slot);
    const FacePoint on = on_flank(grid[row][column], flank);
    points.push_back({flank, on.point + 0.5 * on.normal});
  }
  [[nodiscard]] Points whole_flanks(std::initializer_list<int> sides) const {
    Points points;
    for (const int side : sides) {
      for (std::size_t row = 0; row < kGridRows; ++row) {
        for (std::size_t column = 0; column < kGridColumns; ++column)
          add(points, side, 0, row, column);
      }
    }
    return points;
  }
  // Both flanks of three slots: in the middle, or there and at four points around.
  [[nodiscard]] Points three_slots(bool around) const {
    Points points;
    for (const int slot : {0, 29, 57}) {
      for (const int side : {1, -1}) {
        add(points, side, slot, 3, 7);
        if (!around) continue;
        for (const std::size_t row : {1U, 5U}) {
          for (const std::size_t column : {2U, 12U})
            add(points, side, slot, row, column);
        }
      }
    }
    return points;
  }
  [[nodiscard]] FaceObservability observability(const Points& points) const {
    FaceObservability out;
    EXPECT_TRUE(face_observability(gear, points, settings, out).ok());
    return out;
  }
  void expect_shown(const Points& points, double condition, const ErrorMotion& sd,
                    double relative) const {
    const FaceObservability out = observability(points);
    EXPECT_EQ(out.rank, 6);
    EXPECT_NEAR(out.condition, condition, 0.01 * condition);
    const ErrorMotion got = frame_deviations(gear, out);
    for (Eigen::Index i = 0; i < 6; ++i)
      EXPECT_NEAR(got(i), sd(i), relative * sd(i)) << i;
  }

  FaceGear gear = without_relief(face_gear_of_table_3());
  FaceGrid grid = grid_of(gear, face_grid_of_table_3());
  FaceFrameSettings settings;
};

ErrorMotion motion(double x, double y, double z, double a, double b, double c) {
  ErrorMotion e;
  e << x, y, z, a, b, c;
  return e;
}

// --- observability

TEST_F(FaceFrameTest, OneSideOfManySlotsShowsThreeOfSix) {
  Points points;
  for (int k = 0; k < 6; ++k)
    add(points, 1, 14 * k, 3, 7);
  const FaceObservability out = observability(points);
  EXPECT_EQ(out.rank, 3);
  EXPECT_TRUE(std::isinf(out.condition));
  EXPECT_EQ(out.cofactors.norm(), 0.0);
}

TEST_F(FaceFrameTest, WhatLayoutsShow) {
  expect_shown(whole_flanks({1}), 4130.0, motion(43, 164, 73, 38, 118, 179), 0.01);
  expect_shown(whole_flanks({1, -1}), 144.0, motion(3.1, 2.5, 5.2, 5.0, 5.1, 2.1), 0.02);
  expect_shown(three_slots(false), 3.2, motion(0.76, 0.74, 0.95, 1.4, 1.3, 0.45), 0.03);
  expect_shown(three_slots(true), 3.2, motion(0.34, 0.33, 0.43, 0.61, 0.59, 0.20), 0.02);
}

// --- fits

TEST_F(FaceFrameTest, BringsTheGearBack) {
  for (const bool relieved : {false, true}) {
    gear.relief.amount = relieved ? 0.060 : 0.0;
    gear.relief.begin = 48.4;
    gear.relief.length = 2.4;
    grid = grid_of(gear, face_grid_of_table_3());
    Points points = three_slots(true);
    const Mat3 R = Eigen::AngleAxisd(1.5e-3, Vec3(1.0, -2.0, 1.0).normalized()).matrix();
    const Vec3 t(0.12, -0.15, 0.08);
    for (FaceTouchPoint& p : points)
      p.centre = R.transpose() * (p.centre - t);
    FaceFrame fit;
    std::vector<double> residuals(points.size());
    ASSERT_TRUE(fit_face_frame(gear, points, settings, residuals, fit).ok());
    EXPECT_LT((fit.frame.R - R).norm(), 1e-12);
    EXPECT_LT((fit.frame.t - t).norm(), 1e-10);
    EXPECT_LT(fit.rms, 1e-11);
    EXPECT_LE(fit.steps, 6);
    EXPECT_EQ(fit.observability.rank, 6);
    for (const double e : residuals)
      EXPECT_NEAR(e, 0.0, 1e-11);
  }
}

// Turned about the axis only: one step from the mean.
TEST_F(FaceFrameTest, TheTurnIsTheMeanOfTheDistances) {
  settings.freedom = FrameFreedom::turn;
  Random random;
  SCOPED_TRACE(random.trace());
  Points points = three_slots(true);
  double mean = 0.0;
  for (FaceTouchPoint& p : points) {
    const double off = random.in(-1e-3, 1e-3);
    p.centre = turned_by(-4e-4, p.centre);
    p.centre += off * distance_from_face(gear, p.flank, p.centre).normal;
    const double rest = distance_from_face(gear, p.flank, p.centre).distance - 0.5;
    mean += p.flank.side * rest / gear.arm / static_cast<double>(points.size());
  }
  FaceFrame fit;
  ASSERT_TRUE(fit_face_frame(gear, points, settings, {}, fit).ok());
  EXPECT_NEAR(std::atan2(fit.frame.R(1, 0), fit.frame.R(0, 0)), mean, 1e-15);
  EXPECT_EQ(fit.frame.t.norm(), 0.0);
  EXPECT_EQ(fit.steps, 2);  // and the proof that it was enough
}

// With 0.5 µm of the probe: 0.18, 0.14, 0.21 µm and 0.26, 0.32, 0.11 µm at 172 mm were simulated,
// from 30 points.
TEST_F(FaceFrameTest, NoiseComesThroughAsTheCovarianceSays) {
  constexpr int kFits = 100;
  constexpr double kSigma = 0.5e-3;
  Random random;
  SCOPED_TRACE(random.trace());
  ErrorMotion squares = ErrorMotion::Zero();
  FaceFrame fit;
  for (int i = 0; i < kFits; ++i) {
    Points points = three_slots(true);
    for (FaceTouchPoint& p : points) {
      double noise = 0.0;  // nearly normal
      for (int k = 0; k < 12; ++k)
        noise += random.in(-0.5, 0.5);
      p.centre += kSigma * noise * distance_from_face(gear, p.flank, p.centre).normal;
    }
    ASSERT_TRUE(fit_face_frame(gear, points, settings, {}, fit).ok());
    const Mat3& R = fit.frame.R;
    ErrorMotion found;
    found << fit.frame.t, gear.r_pitch * Vec3(R(2, 1), R(0, 2), R(1, 0));
    squares += found.cwiseAbs2();
  }
  const ErrorMotion sd = frame_deviations(gear, fit.observability);
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_NEAR(std::sqrt(squares(i) / kFits) / (kSigma * sd(i)), 1.0, 0.3) << i;
}

TEST_F(FaceFrameTest, CoordinatesThatAreNotLookedForKeepStill) {
  for (const FrameFreedom freedom :
       {FrameFreedom::shift, FrameFreedom::plane, FrameFreedom::shift_turn}) {
    settings.freedom = freedom;
    Points points = three_slots(true);
    for (FaceTouchPoint& p : points)
      p.centre += Vec3(0.002, -0.001, freedom == FrameFreedom::plane ? 0.0 : 0.0015);
    FaceFrame fit;
    ASSERT_TRUE(fit_face_frame(gear, points, settings, {}, fit).ok());
    EXPECT_NEAR(fit.frame.t.x(), -0.002, 1e-10);
    EXPECT_LT(fit.rms, 1e-11);
    EXPECT_NEAR(fit.frame.R(2, 0), 0.0, 0.0);
    EXPECT_EQ(fit.observability.cofactors(3, 3), 0.0);
    EXPECT_EQ(fit.observability.cofactors(2, 2) > 0.0, freedom != FrameFreedom::plane);
  }
}

// --- refusals

class FaceFrameRefusals : public FaceFrameTest {
 protected:
  Status fit_of(const Points& points) {
    frame.steps = 77;
    const Status status = fit_face_frame(gear, points, settings, {}, frame);
    EXPECT_EQ(frame.steps, 77) << "written to";
    return status;
  }
  FaceFrame frame;
};

TEST_F(FaceFrameRefusals, PointsThatDoNotFixTheFrame) {
  Points few = three_slots(false);
  few.pop_back();
  EXPECT_EQ(fit_of(few).reason, Reason::frame_not_fixed);
  EXPECT_EQ(fit_of(few).where.count, 5);
  EXPECT_EQ(fit_of({}).reason, Reason::frame_not_fixed);
  Points one_side;
  for (int k = 0; k < 6; ++k)
    add(one_side, 1, 14 * k, 3, 7);
  EXPECT_EQ(fit_of(one_side).reason, Reason::frame_not_fixed);
  EXPECT_EQ(fit_of(one_side).where.count, 3);
  EXPECT_EQ(fit_of(whole_flanks({1})).reason, Reason::frame_not_fixed);  // six from one side
  FaceObservability out;
  EXPECT_EQ(face_observability(gear, {}, settings, out).reason, Reason::too_few_points);
}

TEST_F(FaceFrameRefusals, AnOutlierIsNamed) {
  Points points = three_slots(true);
  points[11].centre += 0.04 * distance_from_face(gear, points[11].flank, points[11].centre).normal;
  const Status status = fit_of(points);
  EXPECT_EQ(status.reason, Reason::outlier);
  EXPECT_EQ(status.where.index, 11);
  EXPECT_GT(status.where.deviation, 0.02);
}

TEST_F(FaceFrameRefusals, ResidualsAsLargeAsNoGearHas) {
  settings.sigma = 1.0;
  Points points = three_slots(true);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3 normal = distance_from_face(gear, points[k].flank, points[k].centre).normal;
    points[k].centre += (k % 2 == 0 ? 0.05 : -0.05) * normal;
  }
  EXPECT_EQ(fit_of(points).reason, Reason::outlier);
}

TEST_F(FaceFrameRefusals, PointsWithoutAFoot) {
  Points points = three_slots(true);
  points[4].centre.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fit_of(points).reason, Reason::not_finite);
  EXPECT_EQ(fit_of(points).where.index, 4);
  points[4].centre = {10.0, 0.0, 50.0};
  EXPECT_EQ(fit_of(points).reason, Reason::inside_gear_base);
  EXPECT_EQ(fit_of(points).where.index, 4);
  points = three_slots(true);
  const FacePoint beyond = face_point(gear, points[7].flank, {0.15, 0.42});
  points[7].centre = beyond.point + 0.5 * beyond.normal;
  EXPECT_EQ(fit_of(points).reason, Reason::above_tip);
  EXPECT_EQ(fit_of(points).where.index, 7);
}

TEST_F(FaceFrameRefusals, Settings) {
  const Points points = three_slots(true);
  settings.ball_radius = 0.0;
  EXPECT_STREQ(fit_of(points).where.field, "ball_radius");
  settings.ball_radius = 0.5;
  settings.sigma = -1.0;
  EXPECT_STREQ(fit_of(points).where.field, "sigma");
  settings.sigma = 1.0;
  std::vector<double> residuals(points.size() - 1);
  EXPECT_EQ(fit_face_frame(gear, points, settings, residuals, frame).reason,
            Reason::length_mismatch);
}

}  // namespace
}  // namespace volcomp::test
