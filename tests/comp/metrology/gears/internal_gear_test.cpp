// The internal gear against figures for the gear of docs/papers/internal-helical.md and identities
// of a helicoid.

#include <cmath>
#include <limits>

#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

TEST(InternalGear, HasTheFiguresOfThePapersTable) {
  const InternalGear gear = paper_gear();
  EXPECT_NEAR(2.0 * gear.r, 163.573637, 1e-6);
  EXPECT_NEAR(gear.alpha_t / kDegree, 20.646896, 1e-6);
  EXPECT_NEAR(gear.r_b, 76.533752, 1e-6);
  EXPECT_NEAR(gear.beta_b / kDegree, 14.076095, 1e-6);
  EXPECT_NEAR(gear.screw_parameter(), 305.232561, 1e-6);
  EXPECT_NEAR(2.0 * kPi * gear.screw_parameter(), 1917.8327, 1e-4);
  EXPECT_NEAR(gear.r_tip, 79.786818, 1e-6);
  EXPECT_NEAR(gear.r_root, 84.286818, 1e-6);
  EXPECT_NEAR(gear.normal_lever(), 74.23572, 1e-5);
  EXPECT_NEAR(gear.turn_per_mm / kDegree, 0.18771, 1e-5);  // C per mm of Z
  EXPECT_NEAR(transverse_of(gear, 1.0), 1.030956, 1e-6);
  EXPECT_NEAR(pitch_arc_of(gear, 1.0), 1.101718, 1e-6);
}

TEST(InternalGear, SpaceIsHalfAPitchWideAtTheReferenceCircle) {
  for (const double helix : {-25.0, 0.0, 15.0}) {
    const InternalGear gear = gear_with(79, 2.0, helix);
    EXPECT_NEAR(space_half_angle(gear, gear.r), kPi / (2.0 * 79), 1e-15);
    EXPECT_LT(space_half_angle(gear, gear.r_root), space_half_angle(gear, gear.r_tip));
  }
  InternalGear shifted = given_gear(79, 2.0, 15.0);
  shifted.profile_shift = 0.2;
  ASSERT_TRUE(derive(shifted).ok());
  EXPECT_GT(space_half_angle(shifted, shifted.r), kPi / (2.0 * 79));
}

TEST(InternalGear, FlankIsAHelicoidWithItsNormal) {
  for (const double helix : {-15.0, 0.0, 8.0, 25.0}) {
    const InternalGear gear = gear_with(79, 2.0, helix);
    for (const FlankSide side : kBothSides) {
      for (const double radius : {gear.r_tip, gear.r, gear.r_root}) {
        const SpaceFlankPoint at = space_flank_at(gear, side, radius, 7.0);
        EXPECT_NEAR(std::hypot(at.P.x(), at.P.y()), radius, 1e-12);
        EXPECT_NEAR(at.n.norm(), 1.0, 1e-15);
        const Vec3 along = Vec3(-at.P.y(), at.P.x(), 0.0) * gear.turn_per_mm + Vec3::UnitZ();
        EXPECT_NEAR(along.dot(at.n), 0.0, 1e-14) << "moves along its own helix";
        const double h = 1e-4;
        const Vec3 outwards = (space_flank_at(gear, side, radius + h, 7.0).P -
                               space_flank_at(gear, side, radius - h, 7.0).P) /
                              (2.0 * h);
        EXPECT_NEAR(outwards.dot(at.n), 0.0, 1e-8) << "tangent along the profile";
      }
    }
  }
}

// Out of the material: a step along the normal ends between the two flanks of the space.
TEST(InternalGear, NormalPointsIntoTheSpace) {
  const InternalGear gear = paper_gear();
  for (const FlankSide side : kBothSides) {
    const SpaceFlankPoint at = space_flank_at(gear, side, gear.r, 0.0);
    const Vec3 inside = at.P + 0.5 * at.n;
    const double off = std::atan2(-inside.y(), -inside.x());
    EXPECT_LT(std::abs(off), space_half_angle(gear, std::hypot(inside.x(), inside.y())));
  }
}

TEST(InternalGear, DeviationIsExactAlongTheNormal) {
  const InternalGear gear = gear_with(60, 3.0, -20.0);
  Random random;
  for (int i = 0; i < 200; ++i) {
    const FlankSide side = random.pick({FlankSide::left, FlankSide::right});
    const int space = random.integer(0, 59);
    const double dn = random.uniform(-0.3, 0.3);
    const SpaceFlankPoint at = space_flank_at(gear, side, random.uniform(gear.r_tip, gear.r_root),
                                              random.uniform(-20.0, 20.0));
    const Mat3 turn = axis_rotation(Axis::z, 2.0 * kPi * space / 60.0);
    double found = 0.0;
    ASSERT_TRUE(space_flank_deviation(gear, side, space, turn * (at.P + dn * at.n), found).ok());
    EXPECT_NEAR(found, dn, 1e-12);
  }
}

TEST(InternalGear, PitchArcTowardsPlusTurnsWithTheSide) {
  const InternalGear gear = paper_gear();
  const double turn = 1e-5;  // of all material, towards +angle
  for (const FlankSide side : kBothSides) {
    const SpaceFlankPoint at = space_flank_at(gear, side, gear.r, 0.0);
    double dn = 0.0;
    ASSERT_TRUE(space_flank_deviation(gear, side, 0, axis_rotation(Axis::z, turn) * at.P, dn).ok());
    EXPECT_NEAR(pitch_arc_towards_plus(gear, side, dn), gear.r * turn, 1e-12);
  }
}

Reason reason_of(InternalGear gear) {
  const InternalGear before = gear;
  const Status status = derive(gear);
  EXPECT_EQ(gear.r, before.r) << "a refused gear must stay as it was";
  return status.reason;
}

TEST(InternalGearRefusal, SizesOutsideTheirRange) {
  EXPECT_EQ(reason_of(given_gear(4, 2.0, 15.0)), Reason::bad_setting);
  EXPECT_EQ(reason_of(given_gear(1001, 2.0, 15.0)), Reason::bad_setting);
  EXPECT_EQ(reason_of(given_gear(79, 0.0, 15.0)), Reason::bad_setting);
  EXPECT_EQ(reason_of(given_gear(79, 2.0, 45.1)), Reason::bad_setting);
  EXPECT_EQ(reason_of(given_gear(79, 2.0, std::numeric_limits<double>::quiet_NaN())),
            Reason::not_finite);
  InternalGear named = given_gear(79, 2.0, -46.0);
  EXPECT_STREQ(derive(named).where.field, "helix_angle");
  EXPECT_TRUE(derive(named = given_gear(79, 2.0, 45.0)).ok());
}

TEST(InternalGearRefusal, TipInsideTheBaseCircle) {
  EXPECT_EQ(reason_of(given_gear(20, 2.0, 0.0)), Reason::no_involute_at_tip);
}

TEST(InternalGearRefusal, SpaceThatEndsBeforeItsRoot) {
  InternalGear gear = given_gear(79, 2.0, 15.0);
  gear.dedendum = 3.0;
  EXPECT_EQ(reason_of(gear), Reason::pointed_space);
}

TEST(InternalGearRefusal, PointsThatHaveNoDeviation) {
  const InternalGear gear = paper_gear();
  double dn = 7.0;
  EXPECT_EQ(space_flank_deviation(gear, FlankSide::left, 0, Vec3(-70, 0, 0), dn).reason,
            Reason::inside_base_circle);
  EXPECT_EQ(space_flank_deviation(gear, FlankSide::left, 0,
                                  Vec3(std::numeric_limits<double>::infinity(), 0, 0), dn)
                .reason,
            Reason::not_finite);
  EXPECT_EQ(dn, 7.0);
}

TEST(InternalGear, ZeroHelixIsALegalSpurGear) {
  const InternalGear gear = gear_with(79, 2.0, 0.0);
  EXPECT_TRUE(gear.spur());
  EXPECT_TRUE(std::isinf(gear.screw_parameter()));
  EXPECT_EQ(gear.turn_per_mm, 0.0);
  EXPECT_EQ(space_flank_at(gear, FlankSide::left, gear.r, 5.0).n.z(), 0.0);
}

}  // namespace
}  // namespace volcomp::test
