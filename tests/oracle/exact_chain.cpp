#include "tests/oracle/exact_chain.hpp"

#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

namespace volcomp::test {
namespace {

std::uint64_t seed() {
  constexpr std::uint64_t kDefaultSeed = 20200885;
  const char* text = std::getenv("VOLCOMP_TEST_SEED");
  return text == nullptr ? kDefaultSeed : std::strtoull(text, nullptr, 0);
}

// A rotation matrix in double, row-major.
std::array<double, 9> random_orientation(Random& random) {
  const Real33 R = turn_about(0, random.uniform(-3.0, 3.0)) *
                   turn_about(1, random.uniform(-3.0, 3.0)) *
                   turn_about(2, random.uniform(-3.0, 3.0));
  std::array<double, 9> out{};
  for (std::size_t i = 0; i < 9; ++i) {
    out[i] =
        static_cast<double>(R(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)));
  }
  return out;
}

}  // namespace

Random::Random() : engine_(seed()) {
#ifndef VOLCOMP_GTEST_SUBSET  // there the seed is always the same, and printf would need a heap
  std::printf("VOLCOMP_TEST_SEED=%llu\n", static_cast<unsigned long long>(seed()));
#endif
}

Real33 skew(const Real3& a) {
  Real33 m;
  m << 0, -a(2), a(1), a(2), 0, -a(0), -a(1), a(0), 0;
  return m;
}

Real33 turn_about(int axis, Real angle) {
  const Real s = std::sin(angle);
  const Real c = std::cos(angle);
  Real33 m;
  switch (axis) {
    case 0:
      m << 1, 0, 0, 0, c, -s, 0, s, c;
      break;
    case 1:
      m << c, 0, s, 0, 1, 0, -s, 0, c;
      break;
    default:
      m << c, -s, 0, s, c, 0, 0, 0, 1;
      break;
  }
  return m;
}

Real33 error_rotation(RotationModel model, const Vec3& angles) {
  const Real3 a = angles.cast<Real>();
  const Real33 one = Real33::Identity();
  const Real33 A = skew(a);
  const Real33 x = skew(Real3(a(0), 0, 0));
  const Real33 y = skew(Real3(0, a(1), 0));
  const Real33 z = skew(Real3(0, 0, a(2)));
  switch (model) {
    case RotationModel::rxryrz:
      return turn_about(0, a(0)) * turn_about(1, a(1)) * turn_about(2, a(2));
    case RotationModel::second_order:
      return one + x + y + z + (x * x + y * y + z * z) / 2 + x * y + x * z + y * z;
    case RotationModel::exponential: {
      Real33 sum = one;
      Real33 term = one;
      for (int n = 1; n < 60; ++n) {
        term = (term * A / n).eval();
        sum += term;
      }
      return sum;
    }
    case RotationModel::linear:
      break;
  }
  return one + A;
}

Real44 homogeneous(const Real33& R, const Real3& t) {
  Real44 T = Real44::Identity();
  T.topLeftCorner<3, 3>() = R;
  T.topRightCorner<3, 1>() = t;
  return T;
}

Real3 transform(const Real44& T, const Real3& p) {
  return T.topLeftCorner<3, 3>() * p + T.topRightCorner<3, 1>();
}

Real44 motion_of(const Joint& joint, double q) {
  const Real s = static_cast<Real>(joint.sign) * static_cast<Real>(q);
  const int axis = static_cast<int>(joint.axis);
  if (joint.kind == JointKind::rotary) return homogeneous(turn_about(axis, s), Real3::Zero());
  Real3 t = Real3::Zero();
  if (joint.kind == JointKind::prismatic) t(axis) = s;
  return homogeneous(Real33::Identity(), t);
}

Real44 offset_of(const Joint& joint) {
  Real44 H = Real44::Identity();
  for (Eigen::Index r = 0; r < 3; ++r) {
    H(r, 3) = static_cast<Real>(joint.offset[static_cast<std::size_t>(r)]);
    for (Eigen::Index c = 0; c < 3; ++c)
      H(r, c) = static_cast<Real>(joint.orientation[static_cast<std::size_t>(3 * r + c)]);
  }
  return H;
}

Real44 deviation_of(const ErrorMotion& e, RotationModel model) {
  return homogeneous(error_rotation(model, rotation(e)), translation(e).cast<Real>());
}

Real44 body_pose(const MachineDescription& machine, int body, const Pose& q, const ErrorSet* errors,
                 RotationModel model) {
  if (body == 0) return Real44::Identity();
  const Body& b = machine.body.at(static_cast<std::size_t>(body - 1));
  const bool moves = b.joint.kind != JointKind::fixed;
  Real44 T = body_pose(machine, b.lower, q, errors, model) * offset_of(b.joint);
  if (moves) T = (T * motion_of(b.joint, q.at(b.joint.nc_axis))).eval();
  if (errors == nullptr) return T;
  const ErrorMotion e = moves ? errors->at(b.joint.nc_axis)
                              : ErrorMotion(Eigen::Map<const ErrorMotion>(b.constant_error.data()));
  return T * deviation_of(e, model);
}

MachineDescription random_machine(Random& random, double mm, double rad) {
  MachineDescription m;
  m.body_count = static_cast<std::uint8_t>(random.integer(2, 12));
  std::uint8_t axes = 0;
  for (int k = 0; k < m.body_count; ++k) {
    Body& body = m.body[static_cast<std::size_t>(k)];
    body.lower = static_cast<std::uint8_t>(k == 0 ? 0 : random.integer(1, k));
    Joint& joint = body.joint;
    joint.kind = axes == kMaxAxes
                     ? JointKind::fixed
                     : random.pick({JointKind::fixed, JointKind::prismatic, JointKind::rotary});
    joint.axis = random.pick({Axis::x, Axis::y, Axis::z});
    joint.sign = static_cast<std::int8_t>(random.integer(0, 1) == 0 ? -1 : 1);
    const Vec3 offset = random.vector(400.0);
    joint.offset = {offset.x(), offset.y(), offset.z()};
    if (random.integer(0, 2) == 0) joint.orientation = random_orientation(random);
    if (joint.kind != JointKind::fixed) {
      joint.nc_axis = axes++;
      continue;
    }
    const ErrorMotion e = random.error(mm, rad);
    for (std::size_t c = 0; c < 6; ++c)
      body.constant_error[c] = e(static_cast<Eigen::Index>(c));
  }
  m.work_body = static_cast<std::uint8_t>(random.integer(1, m.body_count));
  m.tool_body = static_cast<std::uint8_t>(random.integer(1, m.body_count));
  const Vec3 tip = random.vector(300.0);
  m.tool_point = {tip.x(), tip.y(), tip.z()};
  return m;
}

MachineChain chain_of(const MachineDescription& machine) {
  MachineChain chain;
  const Status status = MachineChain::build(machine, chain);
  EXPECT_TRUE(status.ok()) << code(status.reason);
  return chain;
}

}  // namespace volcomp::test
