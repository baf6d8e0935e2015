// Stored values → internal convention, against the physical meaning of each convention and side.

#include <gtest/gtest.h>

#include "comp/metrology/tables/volumetric.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

Joint random_joint(Random& random, JointKind kind) {
  Joint joint;
  joint.kind = kind;
  joint.axis = random.pick({Axis::x, Axis::y, Axis::z});
  joint.sign = static_cast<std::int8_t>(random.integer(0, 1) == 0 ? -1 : 1);
  joint.branch = random.pick({Branch::tool, Branch::work});
  return joint;
}

// Fixed side: T = N J. Moving side: T = J N. With exp([e]x) as the rotation both carry any point to
// the same place, exactly.
TEST(ErrorSide, FixedAndMovingSideOfARotaryAxisAreTheSameMotion) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Joint joint = random_joint(random, JointKind::rotary);
    const double q = random.uniform(-20.0, 20.0);
    const ErrorMotion fixed = random.error(0.05, 1e-3);
    const ErrorMotion moving = to_internal(fixed, joint, q, Convention::body, Side::fixed);
    const Real3 p = random.vector(500.0).cast<Real>();
    const Real44 J = motion_of(joint, q);
    const Real3 want = transform(deviation_of(fixed, RotationModel::exponential), transform(J, p));
    const Real3 got = transform(J, transform(deviation_of(moving, RotationModel::exponential), p));
    ASSERT_LE(to_double(want - got).norm(), 1e-15 * 500.0) << q;
  }
}

// Base side of a linear axis: T = N J about the frame before the motion.
TEST(ErrorSide, BaseAndMovingSideOfALinearAxisAreTheSameMotion) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Joint joint = random_joint(random, JointKind::prismatic);
    const double q = random.uniform(-900.0, 900.0);
    const ErrorMotion base = random.error(0.05, 1e-3);
    const ErrorMotion moving = to_internal(base, joint, q, Convention::body, Side::base);
    const Real3 p = random.vector(500.0).cast<Real>();
    const Real44 J = motion_of(joint, q);
    const Real3 want = transform(deviation_of(base, RotationModel::linear), transform(J, p));
    const Real3 got = transform(J, transform(deviation_of(moving, RotationModel::linear), p));
    ASSERT_LE(to_double(want - got).norm(), 1e-15 * 1000.0) << q;
  }
}

TEST(ErrorSide, DoesNothingWhereItDoesNotApply) {
  Random random;
  const ErrorMotion e = random.error(0.05, 1e-3);
  for (const JointKind kind : {JointKind::fixed, JointKind::prismatic, JointKind::rotary}) {
    const Joint joint = random_joint(random, kind);
    EXPECT_EQ(to_internal(e, joint, 3.0, Convention::body, Side::moving), e);
    if (kind != JointKind::rotary) {
      EXPECT_EQ(to_internal(e, joint, 3.0, Convention::body, Side::fixed), e);
    }
    if (kind != JointKind::prismatic) {
      EXPECT_EQ(to_internal(e, joint, 3.0, Convention::body, Side::base), e);
    }
  }
}

// A full turn brings the fixed-side values back; half a turn reverses what lies across the axis.
TEST(ErrorSide, FixedSideAtWholeAndHalfTurns) {
  Joint joint;
  joint.kind = JointKind::rotary;
  joint.axis = Axis::z;
  ErrorMotion e;
  e << 1, 2, 3, 4, 5, 6;
  ErrorMotion half;
  half << -1, -2, 3, -4, -5, 6;
  const double pi = 3.14159265358979323846;
  EXPECT_LE((to_internal(e, joint, 2.0 * pi, Convention::body, Side::fixed) - e).norm(), 1e-14);
  EXPECT_LE((to_internal(e, joint, pi, Convention::body, Side::fixed) - half).norm(), 1e-14);
  // A quarter turn: what points along base X points along −Y of the turned frame.
  e << 1, 0, 0, 0, 0, 0;
  EXPECT_LE(
      (to_internal(e, joint, 0.5 * pi, Convention::body, Side::fixed) - ErrorMotion::Unit(1) * -1.0)
          .norm(),
      1e-15);
}

// ISO 230-1: relative values describe the tool with respect to the workpiece, so that it does not
// matter which of the two travels: E = δ + ε × (p − origin) in both machines.
TEST(Convention, RelativeValuesMeanTheSameForToolAndWorkpieceCarryingAxes) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Vec3 tip = random.vector(400.0);
    const double q = random.uniform(-500.0, 500.0);
    const ErrorMotion relative = random.error(0.05, 1e-4);
    for (const bool carries_work : {false, true}) {
      MachineDescription m;
      m.body_count = 2;
      m.body[1].lower = 1;
      m.body[1].joint.kind = JointKind::prismatic;
      m.body[1].joint.axis = Axis::y;
      m.body[1].joint.sign = carries_work ? -1 : 1;
      m.work_body = carries_work ? 2 : 1;
      m.tool_body = carries_work ? 1 : 2;
      const MachineChain chain = chain_of(m);
      const Pose pose{q};
      ErrorSet errors = zero_errors();
      errors[0] = to_internal(relative, chain.axis(0), q, Convention::relative, Side::moving);
      const Vec3 E =
          first_order_error(chain, pose, errors, Vec3::Zero(), ideal_points(chain, pose, tip))
              .position_base;
      // Workpiece at −q carries the origin away from a standing tool; a moving tool keeps it.
      const Vec3 arm = carries_work ? Vec3(tip + q * Vec3::UnitY()) : tip;
      EXPECT_LE((E - (translation(relative) + rotation(relative).cross(arm))).norm(), 1e-16 * 1e3);
    }
  }
}

TEST(Convention, BodyValuesOfAWorkpieceCarryingAxisAreTheNegative) {
  Random random;
  const ErrorMotion e = random.error(0.05, 1e-4);
  for (const JointKind kind : {JointKind::prismatic, JointKind::rotary}) {
    Joint joint = random_joint(random, kind);
    joint.branch = Branch::work;
    EXPECT_EQ(to_internal(e, joint, 1.0, Convention::relative, Side::moving), ErrorMotion(-e));
    EXPECT_EQ(to_internal(e, joint, 1.0, Convention::body, Side::moving), e);
    joint.branch = Branch::tool;
    EXPECT_EQ(to_internal(e, joint, 1.0, Convention::relative, Side::moving), e);
  }
}

}  // namespace
}  // namespace volcomp::test
