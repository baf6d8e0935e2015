// What internal gears, form wheels and their envelope refuse, and iterations that do not end.

#include <cmath>
#include <limits>

#include "comp/metrology/gears/contact_line.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

TEST(InternalGearRefusal, AnglesShiftsAndHeightsThatCannotBe) {
  const auto refused = [](auto change) {
    InternalGear gear = given_gear(79, 2.0, 15.0);
    change(gear);
    const Status s = derive(gear);
    return s.ok() ? "accepted" : s.where.field;
  };
  EXPECT_STREQ(refused([](InternalGear& g) { g.pressure_angle = 0.0; }), "pressure_angle");
  EXPECT_STREQ(refused([](InternalGear& g) { g.pressure_angle = 0.25 * kPi; }), "pressure_angle");
  EXPECT_STREQ(refused([](InternalGear& g) { g.pressure_angle = kNan; }), "pressure_angle");
  EXPECT_STREQ(refused([](InternalGear& g) { g.profile_shift = kInfinite; }), "profile_shift");
  EXPECT_STREQ(refused([](InternalGear& g) { g.addendum = 0.0; }), "addendum");
}

TEST(FormWheelRefusal, RadiiThatAreNoNumbers) {
  const InternalGear gear = paper_gear();
  WheelSetup setup;
  const Status wheel = wheel_setup(gear, kInfinite, gear.helix_angle, setup);
  EXPECT_EQ(wheel.reason, Reason::not_finite);
  EXPECT_STREQ(wheel.where.field, "wheel_radius");
  setup = setup_for(gear, 40.0);
  WheelContact contact;
  EXPECT_EQ(wheel_contact(gear, setup, FlankSide::left, kNan, contact).reason, Reason::not_finite);
  WheelProfile profile;
  const Status high =
      wheel_profile(gear, setup, FlankSide::left, gear.r_tip, kInfinite, 9, profile);
  EXPECT_EQ(high.reason, Reason::not_finite);
  EXPECT_STREQ(high.where.field, "radius");
}

// Its axis along that of a spur gear, or nowhere: no normal meets it.
TEST(FormWheelRefusal, AWheelThatLiesFlatTouchesNothing) {
  const InternalGear spur = gear_with(79, 2.0, 0.0);
  WheelContact contact;
  for (const WheelSetup& setup : {WheelSetup{40.0, 0.5 * kPi}, WheelSetup{kNan, 0.0}}) {
    const Status s = wheel_contact(spur, setup, FlankSide::left, spur.r, contact);
    EXPECT_EQ(s.reason, Reason::no_contact);
    EXPECT_EQ(s.where.value, spur.r);
  }
}

TEST(ContactLineRefusal, NoRootAndNoFlankBehindIt) {
  InternalGear gear = paper_gear();
  const WheelSetup setup = setup_for(gear, 40.0);
  const WheelProfile profile = profile_for(gear, setup, FlankSide::left, 17);
  RegeneratedPoint made;
  made.radius = 7.0;
  // 20 mm inside the wheel: what it would make lies inside the base circle.
  const double inner = profile.rho0 - 20.0;
  WheelProfile cone = profile;
  cone.knots = 2;
  cone.pitch = 40.0;
  cone.rho0 = inner;
  const double slope = profile.slope[0];
  cone.slope[0] = cone.slope[1] = slope;
  cone.y[0] = profile.y[0] - 20.0 * slope;
  cone.y[1] = cone.y[0] + 40.0 * slope;
  EXPECT_EQ(regenerated_flank(gear, setup, FlankSide::left, cone, inner, made).reason,
            Reason::inside_base_circle);
  gear.turn_per_mm = 1.0;  // the equation as printed, without the screw parameter
  EXPECT_EQ(
      regenerated_flank(gear, setup, FlankSide::left, profile, profile.rho0 + 2.0, made).reason,
      Reason::no_contact);
  EXPECT_EQ(made.radius, 7.0);
}

// Newton's method on t³ − 2t + 2 from 0 goes to 1 and back for ever: the textbook's example as a
// profile, which a cubic piece holds exactly.
TEST(WheelGapRefusal, ACycleOfNewtonsMethodEndsWithoutAContact) {
  WheelProfile cycle;
  cycle.rho0 = 10.0;
  cycle.pitch = 1.0;
  cycle.knots = 2;
  cycle.y[0] = 2.0;
  cycle.slope[0] = -2.0;
  cycle.y[1] = 1.0;
  cycle.slope[1] = 1.0;
  double gap = 7.0;
  const SpaceFlankPoint along_the_radius{Vec3(10.0, 0.0, 0.0), Vec3::UnitX()};
  EXPECT_EQ(wheel_gap(cycle, Frame{}, along_the_radius, gap).reason, Reason::no_contact);
  EXPECT_EQ(gap, 7.0);
}

// A disc of no slope, seen along its plane.
TEST(WheelGapRefusal, ANormalAlongTheWheelNeverMeetsIt) {
  WheelProfile disc;
  disc.rho0 = 10.0;
  disc.pitch = 1.0;
  disc.knots = 2;
  double gap = 7.0;
  const SpaceFlankPoint beside{Vec3(10.0, 1.0, 0.0), Vec3::UnitX()};
  EXPECT_EQ(wheel_gap(disc, Frame{}, beside, gap).reason, Reason::no_contact);
  EXPECT_EQ(gap, 7.0);
}

// Where a wheel position on the way has no contact, the flank has no deviation.
TEST(EnvelopeRefusal, APositionWithoutContactIsPassedOn) {
  const auto least_where = [](auto missing) {
    double least = 7.0;
    const auto gap = [&](double stroke, double& value) {
      value = stroke * stroke;
      return missing(stroke) ? refuse(Reason::no_contact) : Status{};
    };
    return detail::least_gap(gap, 0.0, least);
  };
  EXPECT_TRUE(least_where([](double) { return false; }).ok());
  EXPECT_EQ(least_where([](double s) { return s > 3.0; }).reason, Reason::no_contact);
  // Positions of the scan are 0.1 mm apart; the search between them looks left first.
  EXPECT_EQ(least_where([](double s) { return s > -0.09 && s < -0.01; }).reason,
            Reason::no_contact);
  EXPECT_EQ(least_where([](double s) { return s > 0.01 && s < 0.09; }).reason, Reason::no_contact);
}

TEST(FlankErrorRefusal, SensitivityAndCurvatureNeedAContact) {
  const InternalGear gear = paper_gear();
  const WheelSetup setup = setup_for(gear, 40.0);
  SensitivityRows rows;
  const Status s =
      flank_sensitivity(grinder_chain(), gear, setup, {FlankSide::left, 0.9 * gear.r_b, 0.0}, rows);
  EXPECT_EQ(s.reason, Reason::inside_base_circle);
  double kappa = 7.0;
  EXPECT_FALSE(contact_curvature(gear, setup, FlankSide::left, 0.9 * gear.r_b, kappa).ok());
  EXPECT_EQ(kappa, 7.0);
}

}  // namespace
}  // namespace volcomp::test
