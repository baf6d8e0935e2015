// Gaps to a gear: points of its flanks by the parametric form of the involute, normals by
// differences, and the master gear of the L300G paper by its drawing.

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/sim/artefacts/gear.hpp"

namespace volcomp::sim {
namespace {

constexpr double kStylus = 1.4935;

InvoluteGear gear_with(double helix_deg) {
  InvoluteGear g;
  g.teeth = 31;
  g.module = 4.0;
  g.pressure_angle = 20.0 * kPi / 180.0;
  g.helix_angle = helix_deg * kPi / 180.0;
  g.tip_diameter = 132.0 / std::cos(g.helix_angle);
  g.width = 30.0;
  EXPECT_TRUE(derive(g).ok());
  return g;
}

// A point of an involute helicoid: x, roll length, and which way the flank faces.
Vec3 on_flank(const InvoluteGear& g, const Flank& flank, double s, double x) {
  const double sigma = flank.side == FlankSide::left ? 1.0 : -1.0;
  const double pitch = 2.0 * kPi / g.teeth;
  // Polar angle: from the middle of the tooth by half its thickness at the base, less inv(α).
  const double involute = s / g.r_b - std::atan2(s, g.r_b);
  const double phi =
      flank.tooth * pitch + std::tan(g.helix_angle) * x / g.r + sigma * (g.eta_b - involute);
  const double rho = std::hypot(g.r_b, s);
  return {x, rho * std::cos(phi), rho * std::sin(phi)};
}

Vec3 normal_of(const InvoluteGear& g, const Flank& flank, double s, double x) {
  constexpr double kStep = 1e-5;
  const Vec3 along = on_flank(g, flank, s + kStep, x) - on_flank(g, flank, s - kStep, x);
  const Vec3 across = on_flank(g, flank, s, x + kStep) - on_flank(g, flank, s, x - kStep);
  const Vec3 normal = along.cross(across).normalized();
  // Out of the material: in the sense of the flank.
  const double sigma = flank.side == FlankSide::left ? 1.0 : -1.0;
  const Vec3 p = on_flank(g, flank, s, x);
  const Vec3 around(0.0, -p.z(), p.y());
  return (sigma * normal.dot(around) > 0.0 ? 1.0 : -1.0) * normal;
}

class GearAt : public testing::TestWithParam<double> {};

TEST_P(GearAt, ABallOnTheNormalOfAFlankIsAsFarAwayAsItIs) {
  const InvoluteGear g = gear_with(GetParam());
  const Gear gear(g);
  for (const FlankSide side : {FlankSide::left, FlankSide::right}) {
    for (const int tooth : {0, 7, 30}) {
      for (const double s : {14.0, 21.0, 28.0}) {
        const Flank flank{side, tooth};
        const Vec3 p = on_flank(g, flank, s, 13.0);
        const Vec3 n = normal_of(g, flank, s, 13.0);
        for (const double distance : {-0.05, 0.0, 0.3}) {
          const Gap gap = gear.gap(p + (kStylus + distance) * n, kStylus);
          EXPECT_NEAR(gap.mm, distance, 1e-9) << tooth << " " << s;
          EXPECT_LT((gap.normal - n).norm(), 1e-8);
        }
      }
    }
  }
}

TEST_P(GearAt, DeviationsAreThoseOfThePointTouched) {
  const InvoluteGear g = gear_with(GetParam());
  const Gear gear(g, [](const Flank& flank, double s, double x) {
    const double side = flank.side == FlankSide::left ? 1.0 : 2.0;
    return 1e-3 * (side + 0.1 * flank.tooth + 0.01 * s + 0.001 * x);
  });
  const Flank flank{FlankSide::right, 3};
  const Vec3 centre = on_flank(g, flank, 20.0, 11.0) + kStylus * normal_of(g, flank, 20.0, 11.0);
  EXPECT_NEAR(gear.gap(centre, kStylus).mm, -1e-3 * (2.0 + 0.3 + 0.2 + 0.011), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Helix, GearAt, testing::Values(0.0, 15.0, -25.0));

// Tip diameter 132 mm, root diameter 114 mm, 30 mm wide.
TEST(Gear, EndsAtTipRootAndFaces) {
  const Gear gear(gear_with(0.0));
  const Gap tip = gear.gap({15.0, 70.0, 0.0}, kStylus);
  EXPECT_NEAR(tip.mm, 70.0 - 66.0 - kStylus, 1e-12);
  EXPECT_LT((tip.normal - Vec3::UnitY()).norm(), 1e-12);

  const double half_pitch = kPi / 31.0;
  const Vec3 in_space(15.0, 58.4 * std::cos(half_pitch), 58.4 * std::sin(half_pitch));
  EXPECT_NEAR(gear.gap(in_space, 0.5).mm, 58.4 - 57.0 - 0.5, 1e-12);

  const Gap face = gear.gap({35.0, 60.0, 0.0}, kStylus);
  EXPECT_NEAR(face.mm, 5.0 - kStylus, 1e-12);
  EXPECT_LT((face.normal - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_NEAR(gear.gap({-2.0, 60.0, 0.0}, kStylus).mm, 2.0 - kStylus, 1e-12);

  EXPECT_LT(gear.gap({15.0, 0.0, 0.0}, kStylus).mm, -10.0);
}

}  // namespace
}  // namespace volcomp::sim
