// The table builder recovers a known error motion from what an instrument would have read.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/comp/metrology/tables/campaign.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

// What the instrument would read at the sensed point of a machine on −500…0 mm. Straightness is a
// parabola that vanishes at both ends, so that it has no slope of its own by either rule; all else
// is arbitrary and zero at q = 0.
struct Machine {
  Axis axis;
  Vec3 lever_at_zero;
  int kappa;
  ErrorMotion amplitude;
  ErrorMotion reversal;

  [[nodiscard]] Vec3 lever(double q) const {
    Vec3 L = lever_at_zero;
    L(static_cast<Eigen::Index>(axis)) += kappa * q;
    return L;
  }
  [[nodiscard]] ErrorMotion at_sensed_point(double q) const {
    const double u = (q + 250.0) / 250.0;
    ErrorMotion m;
    for (Eigen::Index c = 0; c < 6; ++c) {
      const bool straightness = c < 3 && c != static_cast<Eigen::Index>(axis);
      const auto k = static_cast<double>(c);
      const double shape =
          straightness ? u * u - 1.0 : std::sin(0.009 * q * (1.0 + 0.3 * k)) + 1e-3 * q;
      m(c) = amplitude(c) * shape;
    }
    return m;
  }
  [[nodiscard]] ErrorMotion reversal_at(double q) const { return reversal * (1.0 - 1e-3 * q); }

  // δ = m − ε × L
  [[nodiscard]] ErrorMotion to_head(const ErrorMotion& m, double q) const {
    ErrorMotion e = m;
    e.head<3>() -= rotation(m).cross(lever(q));
    return e;
  }
};

Machine random_machine(Random& random, Axis axis, int kappa) {
  return {axis, random.vector(600.0), kappa, random.error(0.01, 5e-5), random.error(1e-3, 2e-6)};
}

TEST(TableRecovery, ReturnsTheErrorAtTheReadingHeadExactly) {
  Random random;
  auto built = std::make_unique<BuiltTable>();
  for (int i = 0; i < 60; ++i) {
    const Machine machine = random_machine(random, static_cast<Axis>(i % 3), random.integer(-1, 1));
    const auto along = static_cast<Eigen::Index>(machine.axis);
    Vec3 beam = random.vector(1e-4);  // misalignment of the instrument
    beam(along) = 0.0;
    const ErrorMotion zero = random.error(0.1, 1e-3);  // arbitrary zero of the instrument
    const auto reading = [&](double q, double side) {
      ErrorMotion m = machine.at_sensed_point(q) + zero + 0.5 * side * machine.reversal_at(q);
      m.head<3>() += beam * q;
      return m;
    };
    Campaign c(machine.axis, uniform_targets(-500.0, 50.0, 11));
    c.measured.sensed_at_zero = machine.lever_at_zero;
    c.measured.kappa = machine.kappa;
    c.measured.reference = 10;
    c.measured.slope = i % 2 == 0 ? SlopeFit::least_squares : SlopeFit::end_points;
    for (int run = 0; run < 2; ++run) {
      c.add_up([&](double q) { return reading(q, 1.0); });
      c.add_down([&](double q) { return reading(q, -1.0); });
    }
    ASSERT_TRUE(c.build(*built).ok());

    EXPECT_TRUE(built->reversal_known);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(built->removed_slope[k], beam(static_cast<Eigen::Index>(k)), 1e-17);
    }
    for (std::size_t t = 0; t < 11; ++t) {
      const double q = c.positions[t];
      const ErrorMotion mean = machine.to_head(machine.at_sensed_point(q), q);
      const ErrorMotion half = 0.5 * machine.to_head(machine.reversal_at(q), q);
      ASSERT_EQ(built->table.knot(t), q);
      ASSERT_LE((built->table.forward[t] - (mean + half)).norm(), 1e-15) << t;
      ASSERT_LE((built->table.backward[t] - (mean - half)).norm(), 1e-15) << t;
      ASSERT_LE((built->reversal[t] - machine.reversal_at(q)).norm(), 1e-16) << t;
    }
  }
}

// "Positioning never depends on κ (â × â = 0); straightness does": by ε × q â.
TEST(TableRecovery, KappaMovesStraightnessOnly) {
  Random random;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    const Machine machine = random_machine(random, axis, 0);
    std::array<BuiltTable, 2> built;
    for (int kappa = 0; kappa < 2; ++kappa) {
      Campaign c(axis, uniform_targets(-500.0, 50.0, 11));
      c.measured.sensed_at_zero = machine.lever_at_zero;
      c.measured.kappa = kappa;
      c.measured.reference = 10;
      c.add_up([&](double q) { return machine.at_sensed_point(q); });
      c.add_down([&](double q) { return machine.at_sensed_point(q); });
      ASSERT_TRUE(c.build(built[static_cast<std::size_t>(kappa)]).ok());
    }
    for (std::size_t t = 0; t < 11; ++t) {
      const double q = built[0].positions[t];
      const ErrorMotion change = built[1].table.forward[t] - built[0].table.forward[t];
      const Vec3 epsilon = rotation(machine.at_sensed_point(q));
      const Vec3 want = -epsilon.cross(q * Vec3::Unit(static_cast<Eigen::Index>(axis)));
      EXPECT_LE((translation(change) - want).norm(), 1e-16);
      EXPECT_EQ(translation(change)(static_cast<Eigen::Index>(axis)), 0.0);
      EXPECT_EQ(rotation(change), Vec3::Zero());
    }
  }
}

// Table 5 of the paper is written 0 … −500. The order of writing changes nothing: up is still
// towards increasing coordinate.
TEST(TableRecovery, DescendingPositionsGiveTheSameTable) {
  Random random;
  const Machine machine = random_machine(random, Axis::x, 1);
  std::array<BuiltTable, 2> built;
  for (const bool descending : {false, true}) {
    Campaign c(Axis::x,
               descending ? uniform_targets(0.0, -50.0, 11) : uniform_targets(-500.0, 50.0, 11));
    c.measured.sensed_at_zero = machine.lever_at_zero;
    c.measured.kappa = 1;
    c.measured.reference = descending ? 2 : 8;  // −100 mm
    c.add_up([&](double q) { return ErrorMotion(machine.at_sensed_point(q) + machine.reversal); });
    c.add_down([&](double q) { return machine.at_sensed_point(q); });
    ASSERT_TRUE(c.build(built[descending ? 1 : 0]).ok());
    EXPECT_EQ(built[descending ? 1 : 0].has(Warning::positions_reversed), descending);
  }
  EXPECT_EQ(built[1].table.q0, -500.0);
  EXPECT_EQ(built[1].table.pitch, 50.0);
  for (std::size_t t = 0; t < 11; ++t) {
    EXPECT_LE((built[0].table.forward[t] - built[1].table.forward[t]).norm(), 1e-16);
    EXPECT_LE((built[0].table.backward[t] - built[1].table.backward[t]).norm(), 1e-16);
  }
  EXPECT_LE(built[1].table.at_knot(8, Travel::unknown).norm(), 1e-16);
}

// Rotary axes keep every slope: EA, EB, EC and run-out over the angle are errors, not alignment.
TEST(TableRecovery, RotaryAxisKeepsItsSlopes) {
  Campaign c(Axis::z, uniform_targets(0.0, 0.1, 11));
  c.measured.kind = JointKind::rotary;
  const auto reading = [](double q) {
    ErrorMotion m;
    m << 1e-3 * q, 2e-3 * q, 3e-3 * q, 4e-6 * q, 5e-6 * q, 6e-6 * q;
    return m;
  };
  c.add_up(reading);
  c.add_down(reading);
  BuiltTable built;
  ASSERT_TRUE(c.build(built).ok());
  for (std::size_t t = 0; t < 11; ++t)
    EXPECT_LE((built.table.forward[t] - reading(c.positions[t])).norm(), 1e-17);
  EXPECT_EQ(built.removed_slope, (std::array<double, 3>{}));
  EXPECT_NEAR(built.positioning.E, 6e-6, 1e-18);  // ECC of the C axis
}

TEST(TableRecovery, MeansAndDeviationsOfAHandExample) {
  Campaign c(Axis::y, {0.0, 10.0});
  for (const double um : {1.0, 2.0, 6.0})
    c.add_up([&](double) { return ErrorMotion(1e-3 * um * ErrorMotion::Unit(1)); });
  for (const double um : {-2.0, 0.0})
    c.add_down([&](double) { return ErrorMotion(1e-3 * um * ErrorMotion::Unit(1)); });
  BuiltTable built;
  ASSERT_TRUE(c.build(built).ok());
  EXPECT_NEAR(built.s_up[0](1), std::sqrt(7.0) * 1e-3, 1e-17);  // (4 + 1 + 9) / 2
  EXPECT_NEAR(built.s_down[1](1), std::sqrt(2.0) * 1e-3, 1e-17);
  EXPECT_NEAR(built.reversal[0](1), 4e-3, 1e-17);       // 3 − (−1)
  EXPECT_NEAR(built.table.forward[0](1), 2e-3, 1e-17);  // mean 1, zeroed
  EXPECT_NEAR(built.table.backward[0](1), -2e-3, 1e-17);
  EXPECT_NEAR(built.positioning.B, 4e-3, 1e-17);
  EXPECT_NEAR(built.positioning.R, (2.0 * std::sqrt(7.0) + 2.0 * std::sqrt(2.0) + 4.0) * 1e-3,
              1e-16);
}

// Straight lines survive resampling exactly, whatever the spacing.
TEST(TableRecovery, NonUniformTargetsAreResampledOntoAUniformGrid) {
  Campaign c(Axis::x, {-300.0, -255.0, -190.0, -151.0, -100.0, -47.0, 0.0});
  c.measured.allow_resampling = true;
  c.measured.reference = 6;
  const auto reading = [](double q) {
    ErrorMotion m;
    m << 4e-5 * q, 0, 0, 1e-7 * q, -2e-7 * q, 3e-7 * q;
    return m;
  };
  c.add_up(reading);
  c.add_down(reading);
  BuiltTable built;
  ASSERT_TRUE(c.build(built).ok());
  ASSERT_EQ(built.table.knots, 7U);
  EXPECT_EQ(built.table.pitch, 50.0);
  EXPECT_EQ(built.positions[1], -255.0);
  for (std::size_t t = 0; t < 7; ++t) {
    EXPECT_LE((built.table.forward[t] - reading(-300.0 + 50.0 * static_cast<double>(t))).norm(),
              1e-16);
  }
}

}  // namespace
}  // namespace volcomp::test
