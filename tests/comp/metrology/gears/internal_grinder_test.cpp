// The chain of the internal grinder against its closed form.

#include <cmath>

#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

ErrorSet random_errors(Random& random, double mm, double rad) {
  ErrorSet errors = zero_errors();
  for (ErrorMotion& e : errors)
    e = random.error(mm, rad);
  return errors;
}

// E = Tᵉ T⁻¹ without linearisation.
Frame exact_left_error(const MachineChain& chain, const Pose& q, const ErrorSet& errors,
                       RotationModel model) {
  const Frame ideal = tool_in_work(chain, q);
  const Frame actual = actual_tool_in_work(chain, q, errors, model);
  const Mat3 R = actual.R * ideal.R.transpose();
  return {R, actual.t - R * ideal.t};
}

TEST(InternalGrinder, IsTheLowerBodyArrayOfThePaper) {
  const MachineDescription d = internal_grinder(GrinderY::none);
  const std::array<int, 7> lower{0, 1, 2, 3, 1, 5, 6};
  ASSERT_EQ(d.body_count, 7);
  for (std::size_t k = 0; k < lower.size(); ++k)
    EXPECT_EQ(d.body[k].lower, lower[k]);
  EXPECT_EQ(d.work_body, 4);
  EXPECT_EQ(d.tool_body, 7);
}

// T_gW = Rz(−C) Trans(−x, 0, z) Rx(A).
TEST(InternalGrinder, PutsTheWheelAtMinusX) {
  const MachineChain chain = grinder_chain();
  const Frame wheel = tool_in_work(chain, grinder_pose(44.0, 7.0, 0.0, 0.26));
  EXPECT_NEAR((wheel.t - Vec3(-44.0, 0.0, 7.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((wheel.R - axis_rotation(Axis::x, 0.26)).norm(), 0.0, 1e-15);
  const Frame turned_gear = tool_in_work(chain, grinder_pose(44.0, 7.0, 0.5 * kPi, 0.26));
  EXPECT_NEAR((turned_gear.t - Vec3(0.0, 44.0, 7.0)).norm(), 0.0, 1e-13);
}

TEST(LeftError, IsTheClosedFormOfSection2) {
  const MachineChain chain = grinder_chain();
  Random random;
  for (int i = 0; i < 100; ++i) {
    const double x = random.uniform(20.0, 60.0);
    const double z = random.uniform(-50.0, 50.0);
    const double a = random.uniform(-4.0, 4.0);
    const double b = random.uniform(-0.5, 0.5);
    const ErrorSet e = random_errors(random, 0.01, 1e-4);
    const LeftError error = left_error(chain, grinder_pose(x, z, a, b), e);
    const Mat3 back = axis_rotation(Axis::z, -a);
    const Mat3 swivel = axis_rotation(Axis::x, b);
    const Vec3 v = rotation(e[kGrinderZ]) + swivel * rotation(e[kGrinderA]);
    const Vec3 tau(-z * v.y(), z * v.x() + x * v.z(), -x * v.y());
    const Vec3 eps = -rotation(e[kGrinderC]) + back * (v - rotation(e[kGrinderX]));
    const Vec3 delta =
        -translation(e[kGrinderC]) + back * (translation(e[kGrinderZ]) - translation(e[kGrinderX]) +
                                             swivel * translation(e[kGrinderA]) + tau);
    EXPECT_NEAR((error.eps - eps).norm(), 0.0, 1e-17);
    EXPECT_NEAR((error.delta - delta).norm(), 0.0, 1e-15);
  }
}

TEST(LeftError, ExactAndFirstOrderDifferBySecondOrder) {
  const MachineChain chain =
      grinder_chain(GrinderY::on_z, {{0, 0, 150}, {}, {}, {10, 20, 300}, {0, 5, -60}});
  Random random;
  const Pose q = grinder_pose(44.0, 12.0, 0.7, 0.26);
  const ErrorSet errors = random_errors(random, 0.01, 1e-4);
  ErrorSet tenth = errors;
  for (ErrorMotion& e : tenth)
    e *= 0.1;
  const Vec3 P(-80.0, 3.0, 12.0);
  const auto off = [&](const ErrorSet& set) {
    const Frame exact = exact_left_error(chain, q, set, RotationModel::exponential);
    return Vec3(exact.apply(P) - P - left_error(chain, q, set).at(P)).norm();
  };
  EXPECT_LT(off(errors), 1e-3);
  EXPECT_LT(off(tenth), 0.012 * off(errors));
}

// docs/papers/internal-helical.md, Table 2: 0.033 degrees differ by 14 nm at the rim of the wheel.
TEST(LeftError, PrintedMatricesAreNoRotations) {
  const MachineChain chain = grinder_chain();
  ErrorSet errors = zero_errors();
  errors[kGrinderC](5) = 0.033 * kDegree;
  const Pose q = grinder_pose(44.286818, 0.0, 0.0, 0.26);
  const Vec3 P(-84.286818, 0.0, 0.0);
  const Vec3 exact = exact_left_error(chain, q, errors, RotationModel::exponential).apply(P);
  const Vec3 printed = exact_left_error(chain, q, errors, RotationModel::linear).apply(P);
  EXPECT_NEAR((exact - printed).norm() * kNmPerMm, 14.0, 0.1);
}

TEST(LeftError, SensitivityIsItsGradient) {
  const MachineChain chain =
      grinder_chain(GrinderY::under_z, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {}, {9, 9, 9}});
  Random random;
  Pose q = grinder_pose(44.0, 12.0, 0.7, 0.26);
  q[kGrinderY] = 3.0;
  const Vec3 P(-80.0, 3.0, 12.0);
  const Vec3 n = random.vector(1.0).normalized();
  const SensitivityRows rows = left_error_sensitivity(chain, q, P, n);
  for (int i = 0; i < 20; ++i) {
    const ErrorSet errors = random_errors(random, 0.01, 1e-4);
    double sum = 0.0;
    for (std::size_t a = 0; a < chain.axis_count(); ++a)
      sum += rows[a].dot(errors[a]);
    EXPECT_NEAR(sum, n.dot(left_error(chain, q, errors).at(P)), 1e-15);
  }
}

// 1 µm in Y is worth 12.3 µrad in C.
TEST(InternalGrinder, TakesAYSlideOnEitherSideOfZ) {
  const InternalGear gear = paper_gear();
  const WheelSetup setup = setup_for(gear, 40.0);
  const ContactInstant at = instant_of(gear, setup, {FlankSide::left, gear.r, 0.0});
  for (const GrinderY y : {GrinderY::on_z, GrinderY::under_z}) {
    const MachineChain chain = grinder_chain(y);
    ASSERT_EQ(chain.axis_count(), 5U);
    EXPECT_EQ(chain.axis(kGrinderY).letter, 'Y');
    const SensitivityRows rows =
        left_error_sensitivity(chain, grinding_pose(gear, setup, at.stroke), at.P, at.n);
    EXPECT_NEAR(rows[kGrinderY](1), 0.914, 5e-4);
    EXPECT_NEAR(rows[kGrinderY](1) / rows[kGrinderC](5) * 1e6, 12.3e3, 0.05e3);
  }
}

// Errors "before the axis" (a base-side table) act like the converted ones after it.
TEST(BaseSideErrors, BecomeMovingSideErrors) {
  Random random;
  const MachineChain chain = grinder_chain();
  const double x = 44.0;
  const ErrorMotion before = random.error(0.01, 1e-4);
  ErrorSet errors = zero_errors();
  errors[kGrinderX] = to_internal(before, chain.axis(kGrinderX), x, Convention::body, Side::base);
  // The same as a constant error of a fixed body under X.
  MachineDescription d = internal_grinder(GrinderY::none);
  for (std::size_t k = d.body_count; k > 1; --k) {
    d.body[k] = d.body[k - 1];
    d.body[k].lower =
        static_cast<std::uint8_t>(d.body[k].lower == 1 && k != 2 ? 1 : d.body[k].lower + 1);
  }
  d.body[1] = {};
  d.body[1].lower = 1;
  Eigen::Map<ErrorMotion>(d.body[1].constant_error.data()) = before;
  ++d.body_count;
  d.work_body = 5;
  d.tool_body = 8;
  const MachineChain with_fixed = chain_of(d);
  const Pose q = grinder_pose(x, 5.0, 0.4, 0.26);
  const LeftError moving = left_error(chain, q, errors);
  const LeftError base = left_error(with_fixed, q, zero_errors());
  EXPECT_NEAR((moving.delta - base.delta).norm(), 0.0, 1e-15);
  EXPECT_NEAR((moving.eps - base.eps).norm(), 0.0, 1e-17);
}

TEST(InternalGrinderRefusal, NamesTheBodyAndKeepsTheOldMachine) {
  MachineChain chain = grinder_chain();
  MachineDescription bad = internal_grinder(GrinderY::none);
  bad.body[4].lower = 6;
  const Status order = MachineChain::build(bad, chain);
  EXPECT_EQ(order.reason, Reason::parent_not_lower);
  EXPECT_EQ(order.where.body, 5);
  bad = internal_grinder(GrinderY::none);
  bad.body[4].lower = 0;
  EXPECT_EQ(MachineChain::build(bad, chain).reason, Reason::not_one_root);
  bad = internal_grinder(GrinderY::none);
  bad.body[1].joint.orientation[1] = 2e-6;
  EXPECT_EQ(MachineChain::build(bad, chain).reason, Reason::not_a_rotation);
  bad = internal_grinder(GrinderY::none);
  bad.body[1].joint.orientation = {1, 0, 0, 0, 1, 0, 0, 0, -1};  // mirrored
  EXPECT_EQ(MachineChain::build(bad, chain).reason, Reason::not_a_rotation);
  EXPECT_EQ(chain.axis_count(), 4U);
}

}  // namespace
}  // namespace volcomp::test
