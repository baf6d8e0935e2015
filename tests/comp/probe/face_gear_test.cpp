// Face gears by their figures: those the paper (docs/papers/face-gear.md) prints, and what cannot
// be made.

#include <limits>

#include "comp/probe/face_relief.hpp"
#include "tests/oracle/face_gears.hpp"

namespace volcomp::test {
namespace {

TEST(FaceGear, LimitsOfTheTwoGearsOfThePaper) {
  const FaceGear one = face_gear_of_table_1();
  EXPECT_NEAR(one.arm, 250.957, 5e-4);
  EXPECT_NEAR(one.undercut_radius, 253.365, 5e-4);
  EXPECT_NEAR(one.pointing_radius, 313.504, 5e-4);
  const FaceGear three = face_gear_of_table_3();
  EXPECT_NEAR(three.arm, 155.885, 5e-4);
  EXPECT_NEAR(three.undercut_radius, 159.821, 5e-4);
  EXPECT_NEAR(three.pointing_radius, 193.792, 5e-4);
}

// Table 1 prints 6.170 mm.
TEST(FaceGear, ToothThicknessInTheMiddleOfTheFace) {
  const FaceGear gear = face_gear_of_table_1();
  EXPECT_NEAR(tooth_thickness(gear, 279.25, gear.r_ps), 6.1717, 5e-5);
}

TEST(FaceGear, SlotsAreAsWideAsTheShaperSweeps) {
  for (const FaceGear& gear : {face_gear_of_table_1(), face_gear_of_table_3(), small_face_gear()}) {
    const FaceGrid grid = grid_of(gear, plan_face_grid(gear));
    for (std::size_t row = 0; row < kGridRows; row += 2) {
      for (std::size_t column = 0; column < kGridColumns; column += 7) {
        const FaceParameters at = grid[row][column].at;
        const Vec3 p = generated_point(gear, at.theta, at.beta);
        const double rho = std::hypot(p.x(), p.y());
        EXPECT_NEAR(half_slot_angle(gear, rho, p.z()), swept_half_slot(gear, rho, p.z()), 1e-13);
      }
    }
  }
}

TEST(FaceGear, TeethArePointedAtThePointingRadius) {
  const FaceGear gear = face_gear_of_table_3();
  EXPECT_NEAR(tooth_thickness(gear, gear.pointing_radius, gear.z_tip), 0.0, 1e-11);
  EXPECT_GT(tooth_thickness(gear, gear.pointing_radius - 1.0, gear.z_tip), 0.1);
}

TEST(FaceGear, RadiiLeftOpenAreTheLimits) {
  const FaceGear gear = face_gear_of_table_3();
  EXPECT_EQ(gear.r_in, gear.undercut_radius);
  EXPECT_EQ(gear.r_out, gear.pointing_radius);
}

// --- refusals

struct Wrong {
  const char* field;
  void (*spoil)(FaceGear&);
};

TEST(FaceGear, WhatCannotBeMadeIsNamed) {
  const Wrong wrongs[] = {
      {"shaper_teeth", [](FaceGear& g) { g.shaper_teeth = 4; }},
      {"teeth", [](FaceGear& g) { g.teeth = g.shaper_teeth; }},
      {"teeth", [](FaceGear& g) { g.teeth = kMaxFaceGearTeeth + 1; }},
      {"module", [](FaceGear& g) { g.module = 0.0; }},
      {"module", [](FaceGear& g) { g.module = std::numeric_limits<double>::quiet_NaN(); }},
      {"pressure_angle", [](FaceGear& g) { g.pressure_angle = 9.9 * kDegree; }},
      {"pressure_angle", [](FaceGear& g) { g.pressure_angle = 35.1 * kDegree; }},
      {"pressure_angle", [](FaceGear& g) { g.pressure_angle = 25.0; }},  // degrees
      {"addendum", [](FaceGear& g) { g.addendum = -1.0; }},
      {"shaper_addendum", [](FaceGear& g) { g.shaper_addendum = 2.1; }},
      {"r_in", [](FaceGear& g) { g.r_in = g.undercut_radius - 0.1; }},
      {"r_in", [](FaceGear& g) { g.r_in = std::numeric_limits<double>::quiet_NaN(); }},
      {"r_out", [](FaceGear& g) { g.r_out = g.pointing_radius + 0.1; }},
      {"r_out", [](FaceGear& g) { g.r_out = g.r_in - 1.0; }},
      {"relief.amount", [](FaceGear& g) { g.relief.amount = 60.0; }},  // micrometres
      {"relief.length",
       [](FaceGear& g) {
         g.relief = {0.06, 48.4, 0.0};
       }},
      {"relief.begin",
       [](FaceGear& g) {
         g.relief = {0.06, std::numeric_limits<double>::infinity(), 2.4};
       }},
  };
  for (const Wrong& wrong : wrongs) {
    FaceGear gear = face_gear_of_table_1();
    wrong.spoil(gear);
    const double arm = gear.arm;
    const Status status = derive(gear);
    EXPECT_EQ(status.reason, Reason::bad_gear) << wrong.field;
    EXPECT_STREQ(status.where.field, wrong.field);
    EXPECT_TRUE(status.where.has_value);
    EXPECT_EQ(gear.arm, arm);
  }
}

// --- the points that are measured

// Ten printed points of Table 3, four decimals, and the corner of its control points.
TEST(FaceGrid, IsThatOfTable3) {
  const FaceGear gear = face_gear_of_table_3();
  const FaceGrid grid = grid_of(gear, face_grid_of_table_3());
  struct Printed {
    std::size_t row;
    std::size_t column;
    Vec3 point;
  };
  const Printed table[] = {
      {0, 0, {162.499, 4.2239, 46.6096}},  {1, 0, {162.500, 3.9336, 47.5024}},
      {2, 0, {162.500, 3.6601, 48.4000}},  {3, 0, {162.500, 3.4485, 49.1212}},
      {4, 0, {162.500, 3.2387, 49.8425}},  {2, 14, {182.500, 4.4714, 48.4000}},
      {3, 14, {182.500, 3.5710, 49.8785}}, {4, 14, {182.500, 2.6706, 51.3571}},
      {5, 14, {182.500, 1.7701, 52.8356}}, {6, 14, {182.500, 0.8699, 54.3142}},
      {0, 14, {182.497, 5.5957, 46.6175}},
  };
  for (const Printed& p : table) {
    const FaceFoot foot = distance_from_relieved_face(gear, {}, p.point);
    EXPECT_EQ(foot.reason, Reason::ok);
    EXPECT_NEAR(foot.distance, 0.0, 0.16e-3) << p.row << ' ' << p.column;
    EXPECT_LT((p.point - grid[p.row][p.column].point).norm(), 1.5e-3);  // x has three decimals
  }
}

// What is printed of the last row lies 0.15 modules above the fillet, at both ends.
TEST(FaceGrid, EndsBeforeTheFillet) {
  const FaceGear gear = face_gear_of_table_3();
  const FaceGridPlan plan = face_grid_of_table_3();
  EXPECT_NEAR(fillet_depth(gear, plan.first_x) - 0.6, plan.first_root_depth, 2e-4);
  EXPECT_NEAR(fillet_depth(gear, plan.last_x) - 0.6, plan.last_root_depth, 2e-4);
}

TEST(FaceGrid, LiesOnEveryGear) {
  for (const FaceGear& gear : {face_gear_of_table_1(), small_face_gear()}) {
    const FaceGrid grid = grid_of(gear, plan_face_grid(gear));
    EXPECT_NEAR(grid[0][0].point.z(), gear.z_tip + 0.15 * gear.module, 1e-12);
    for (const auto& row : grid) {
      for (const FaceGridNode& node : row)
        EXPECT_NEAR(distance_from_face(gear, {}, node.point).distance, 0.0, 1e-12);
    }
  }
}

TEST(FaceGrid, APointOffTheFlankIsNamed) {
  const FaceGear gear = face_gear_of_table_3();
  FaceGridPlan plan = face_grid_of_table_3();
  plan.last_root_depth = 58.0;
  FaceGrid grid;
  const Status status = make_face_grid(gear, plan, grid);
  EXPECT_EQ(status.reason, Reason::in_fillet);
  EXPECT_EQ(status.where.index / 15, 5);
  plan.first_x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(make_face_grid(gear, plan, grid).reason, Reason::not_finite);
}

}  // namespace
}  // namespace volcomp::test
