// Wheel and contact: figures for the gear of docs/papers/internal-helical.md, and that the wheel
// grinds the flank it was made for.

#include <algorithm>
#include <cmath>

#include "comp/metrology/gears/contact_line.hpp"
#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

WheelContact contact_at(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                        double radius) {
  WheelContact contact;
  EXPECT_TRUE(wheel_contact(gear, setup, side, radius, contact).ok());
  return contact;
}

TEST(FormWheel, HasTheProfileOfTheWorkedExample) {
  const InternalGear gear = paper_gear();
  const WheelSetup setup = setup_for(gear, 40.0);
  struct Row {
    double r, z, rho, y;
  };
  for (const Row& row : {Row{79.786818, 0.53860, 35.482418, -2.171762},
                         Row{81.786818, -0.22219, 37.485481, -1.570704},
                         Row{83.786818, -0.68174, 39.500575, -0.799577}}) {
    const WheelContact left = contact_at(gear, setup, FlankSide::left, row.r);
    EXPECT_NEAR(left.flank.P.z(), row.z, 6e-6);
    EXPECT_NEAR(left.rho, row.rho, 2e-6);
    EXPECT_NEAR(left.y, row.y, 2e-6);
    const WheelContact right = contact_at(gear, setup, FlankSide::right, row.r);
    EXPECT_NEAR(right.flank.P.z(), -left.flank.P.z(), 1e-12);
    EXPECT_NEAR(right.y, -left.y, 1e-12);
    EXPECT_NEAR(right.rho, left.rho, 1e-12);
  }
}

// This length decides what profile error the motion of the axes can cause.
TEST(FormWheel, ContactLineGrowsWithTheWheel) {
  const InternalGear gear = paper_gear();
  struct Row {
    double wheel, length;
  };
  for (const Row& row : {Row{20.0, 0.34}, Row{40.0, 1.22}, Row{60.0, 2.14}}) {
    const WheelSetup setup = setup_for(gear, row.wheel);
    const double tip = contact_at(gear, setup, FlankSide::left, gear.r_tip).flank.P.z();
    const double form = contact_at(gear, setup, FlankSide::left, gear.r + gear.module).flank.P.z();
    EXPECT_NEAR(std::abs(tip - form), row.length, 0.006) << row.wheel;
  }
}

TEST(FormWheel, SlopeIsTheDerivativeOfTheProfile) {
  const InternalGear gear = paper_gear();
  const WheelSetup setup = setup_for(gear, 40.0);
  const double h = 1e-3;
  const WheelContact below = contact_at(gear, setup, FlankSide::left, gear.r - h);
  const WheelContact at = contact_at(gear, setup, FlankSide::left, gear.r);
  const WheelContact above = contact_at(gear, setup, FlankSide::left, gear.r + h);
  EXPECT_NEAR((above.y - below.y) / (above.rho - below.rho), at.slope, 1e-7);
}

// Over the flank in use, from the tip to the form circle.
double worst_nm(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                std::size_t knots) {
  WheelProfile profile;
  EXPECT_TRUE(
      wheel_profile(gear, setup, side, gear.r_tip, gear.r + gear.module, knots, profile).ok());
  double worst = 0.0;
  for (int i = 0; i <= 500; ++i) {
    const double rho = profile.rho0 + (profile.last() - profile.rho0) * i / 500.0;
    RegeneratedPoint point;
    EXPECT_TRUE(regenerated_flank(gear, setup, side, profile, rho, point).ok());
    worst = std::max(worst, std::abs(point.deviation) * kNmPerMm);
  }
  return worst;
}

// 15.5, 1.28, 0.065, 0.004, 0.00024 nm: a Hermite cubic loses a factor of 16 per halving.
TEST(FormWheel, GrindsItsFlankTheBetterTheMoreKnots) {
  const InternalGear gear = paper_gear();
  const WheelSetup setup = setup_for(gear, 40.0);
  std::array<double, 5> worst{};
  for (std::size_t i = 0; i < worst.size(); ++i) {
    worst[i] = worst_nm(gear, setup, FlankSide::left, (4U << i) + 1U);
    RecordProperty("nm_with_" + std::to_string((4U << i) + 1U) + "_knots",
                   std::to_string(worst[i]));
  }
  EXPECT_LT(worst[0], 40.0);
  EXPECT_LT(worst[2], 0.2);
  EXPECT_LT(worst[4], 0.001);
  for (std::size_t i = 1; i < worst.size(); ++i)
    EXPECT_LT(worst[i], worst[i - 1] / 8.0);
}

TEST(FormWheel, SeventeenKnotsKeepTheFlankOfAnyGearBelowOneNanometre) {
  for (const auto& [teeth, module, helix, wheel] :
       {std::tuple{79, 2.0, 15.0, 40.0}, std::tuple{79, 2.0, -15.0, 40.0},
        std::tuple{101, 1.5, 8.0, 37.0}, std::tuple{60, 3.0, 20.0, 47.0},
        std::tuple{79, 2.0, 25.0, 42.0}, std::tuple{79, 2.0, 0.0, 40.0}}) {
    const InternalGear gear = gear_with(teeth, module, helix);
    for (const double off_swivel : {0.0, 0.5 * kDegree}) {
      const WheelSetup setup = setup_for(gear, wheel, off_swivel);
      for (const FlankSide side : kBothSides)
        EXPECT_LT(worst_nm(gear, setup, side, 17), 1.0) << helix << " " << off_swivel;
    }
  }
}

TEST(FormWheel, OfASpurGearTouchesInOnePlane) {
  const InternalGear gear = gear_with(79, 2.0, 0.0);
  const WheelContact at = contact_at(gear, setup_for(gear, 40.0), FlankSide::left, gear.r);
  EXPECT_NEAR(at.flank.P.z(), 0.0, 1e-15);
  EXPECT_EQ(at.flank.n.z(), 0.0);
}

// The wheel does not cut into its own flank anywhere along the stroke.
TEST(FormWheel, LeavesTheFlankItHasGround) {
  const InternalGear gear = paper_gear();
  const WheelSetup setup = setup_for(gear, 40.0);
  for (const FlankSide side : kBothSides) {
    const WheelProfile profile = profile_for(gear, setup, side, kWheelKnots);
    for (const double radius : {gear.r_tip, gear.r, gear.r + gear.module}) {
      const WheelContact at = contact_at(gear, setup, side, radius);
      for (int i = -50; i <= 50; ++i) {
        double gap = 0.0;
        ASSERT_TRUE(wheel_gap(profile, generating_frame(gear, setup, 0.1 * i), at.flank, gap).ok());
        EXPECT_GT(gap, -0.00015e-6);
      }
    }
  }
}

TEST(ContactLine, PrintedEquationHasNoRoot) {
  const InternalGear gear = paper_gear();
  const WheelSetup setup = setup_for(gear, 40.0);
  const WheelContact at = contact_at(gear, setup, FlankSide::left, gear.r);
  GeneratedPoint point;
  point.phi = 7.0;
  const auto solve = [&](double p) {
    return generated_point({setup, 1.0 / p}, at.rho, {at.y, at.slope}, default_contact_window(),
                           point);
  };
  EXPECT_EQ(solve(1.0).reason, Reason::no_contact);
  EXPECT_EQ(point.phi, 7.0) << "never the last iterate";
  ASSERT_TRUE(solve(gear.screw_parameter()).ok());
  EXPECT_NEAR(point.phi, at.phi, 1e-9);
  EXPECT_NEAR((point.point - at.flank.P).norm(), 0.0, 1e-9);
  EXPECT_NEAR((point.normal + at.flank.n).norm(), 0.0, 1e-9);
}

TEST(FormWheelRefusal, WheelsThatDoNotFit) {
  const InternalGear gear = paper_gear();
  WheelSetup setup;
  EXPECT_EQ(wheel_setup(gear, gear.r_tip, 0.2, setup).reason, Reason::wheel_too_large);
  EXPECT_EQ(wheel_setup(gear, 0.0, 0.2, setup).reason, Reason::bad_setting);
  EXPECT_EQ(wheel_setup(gear, 40.0, 1.2, setup).reason, Reason::bad_setting);
  EXPECT_EQ(wheel_setup(gear, 40.0, std::nan(""), setup).reason, Reason::not_finite);
}

TEST(FormWheelRefusal, ProfilesThatCannotBe) {
  const InternalGear gear = paper_gear();
  const WheelSetup setup = setup_for(gear, 40.0);
  WheelProfile profile;
  const auto reason = [&](double low, double high, std::size_t knots) {
    return wheel_profile(gear, setup, FlankSide::left, low, high, knots, profile).reason;
  };
  EXPECT_EQ(reason(80.0, 83.0, 1), Reason::too_few_knots);
  EXPECT_EQ(reason(80.0, 83.0, kWheelKnots + 1), Reason::too_many_knots);
  EXPECT_EQ(reason(83.0, 80.0, 17), Reason::bad_setting);
  EXPECT_EQ(reason(70.0, 83.0, 17), Reason::inside_base_circle);
  EXPECT_EQ(profile.knots, 0U);
}

}  // namespace
}  // namespace volcomp::test
