// The deviation recursion against plain products of 4×4 matrices in long double, random machines.

#include <gtest/gtest.h>

#include "comp/metrology/tables/volumetric.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

constexpr RotationModel kModels[] = {RotationModel::rxryrz, RotationModel::exponential,
                                     RotationModel::second_order, RotationModel::linear};

// The definition, from the root of the machine: the common trunk has to cancel by itself.
struct Truth {
  Real3 base;   // T_t P_t + C − T_w P_w in the frame of the last common body
  Real3 work;   // T_w⁻¹ (T_t P_t + C) − P_w
  Real33 turn;  // actual relative rotation · (ideal relative rotation)⁻¹, work frame
  Real33 work_rotation;
};

int last_common_body(const MachineDescription& m) {
  std::vector<int> ancestors;
  for (int k = m.work_body; k != 0; k = m.body[static_cast<std::size_t>(k - 1)].lower)
    ancestors.push_back(k);
  int k = m.tool_body;
  while (std::find(ancestors.begin(), ancestors.end(), k) == ancestors.end())
    k = m.body[static_cast<std::size_t>(k - 1)].lower;
  return k;
}

Truth truth(const MachineDescription& m, const Pose& q, const ErrorSet& errors, const Vec3& C,
            RotationModel model) {
  const int base = last_common_body(m);
  const auto in_base = [&](int body, const ErrorSet* e) -> Real44 {
    return body_pose(m, base, q, e, model).inverse() * body_pose(m, body, q, e, model);
  };
  const Real44 ideal_tool = in_base(m.tool_body, nullptr);
  const Real44 ideal_work = in_base(m.work_body, nullptr);
  const Real44 tool = in_base(m.tool_body, &errors);
  const Real44 work = in_base(m.work_body, &errors);
  const Real3 tip = Eigen::Map<const Vec3>(m.tool_point.data()).cast<Real>();
  const Real3 on_work = transform(ideal_work.inverse(), transform(ideal_tool, tip));
  const Real3 actual = transform(tool, tip) + C.cast<Real>();
  const Real33 ideal_turn = (ideal_work.inverse() * ideal_tool).topLeftCorner<3, 3>();
  const Real33 turn = (work.inverse() * tool).topLeftCorner<3, 3>();
  return {actual - transform(work, on_work), transform(work.inverse(), actual) - on_work,
          turn * ideal_turn.inverse(), ideal_work.topLeftCorner<3, 3>()};
}

struct Situation {
  MachineDescription machine;
  MachineChain chain;
  Pose q{};
  ErrorSet errors = zero_errors();
  Vec3 C = Vec3::Zero();
};

Situation situation(Random& random, double mm, double rad) {
  Situation s;
  s.machine = random_machine(random, mm, rad);
  s.chain = chain_of(s.machine);
  for (std::size_t a = 0; a < s.chain.axis_count(); ++a) {
    const bool turns = s.chain.axis(a).kind == JointKind::rotary;
    s.q[a] = turns ? random.uniform(-10.0, 10.0) : random.uniform(-600.0, 600.0);
    s.errors[a] = random.error(mm, rad);
  }
  s.C = random.vector(mm);
  return s;
}

VolumetricError evaluate(const Situation& s, RotationModel model) {
  return exact_error(s.chain, s.q, s.errors, s.C, model,
                     ideal_points(s.chain, s.q, s.chain.tool_point()));
}

// 3e-14 mm of an error of 1 mm: six digits better than the difference of two products in double.
TEST(ExactError, EqualsTheProductOfMatricesForEveryModelAndChain) {
  constexpr double kAllowed = 3e-14 + 1e4 * kRealEpsilon;  // levers of the oracle: metres
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const Situation s = situation(random, 0.05, 1e-4);
    for (const RotationModel model : kModels) {
      const Truth want = truth(s.machine, s.q, s.errors, s.C, model);
      const VolumetricError got = evaluate(s, model);
      // The second-order model inverts by its transpose, which is right to second order.
      const double allowed = model == RotationModel::second_order ? 3e-8 : kAllowed;
      ASSERT_LE((got.position_base - to_double(want.base)).norm(), kAllowed) << "machine " << i;
      ASSERT_LE((got.position_work - to_double(want.work)).norm(), allowed) << "machine " << i;
    }
  }
}

TEST(ExactError, StaysExactForErrorsOfMillimetresAndDegrees) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Situation s = situation(random, 5.0, 0.1);
    for (const RotationModel model : {RotationModel::rxryrz, RotationModel::exponential}) {
      const Truth want = truth(s.machine, s.q, s.errors, s.C, model);
      const VolumetricError got = evaluate(s, model);
      ASSERT_LE((got.position_base - to_double(want.base)).norm(), 1e-11) << "machine " << i;
      ASSERT_LE((got.position_work - to_double(want.work)).norm(), 1e-11) << "machine " << i;
    }
  }
}

// One error seen from two frames: E_work = R_w⁻¹ E_base, R_w the ACTUAL orientation of the work
// holder; with the ideal one it holds to first order only.
TEST(ExactError, WorkFrameValueIsTheBaseValueTurnedByTheActualWorkHolder) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Situation s = situation(random, 0.05, 1e-3);
    const VolumetricError got = evaluate(s, RotationModel::rxryrz);
    const int base = last_common_body(s.machine);
    const Real44 work =
        body_pose(s.machine, base, s.q, &s.errors, RotationModel::rxryrz).inverse() *
        body_pose(s.machine, s.machine.work_body, s.q, &s.errors, RotationModel::rxryrz);
    const Real33 R = work.topLeftCorner<3, 3>();
    const Real3 want = R.inverse() * got.position_base.cast<Real>();
    ASSERT_LE((got.position_work - to_double(want)).norm(), 1e-13);
  }
}

// log(R) by the angle and axis of R in long double.
Vec3 logarithm(const Real33& R) {
  const Real3 v(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  const Real sine = v.norm() / 2;
  if (sine < 1e-30L) return Vec3::Zero();
  return to_double(v / 2 * (std::asin(sine) / sine));
}

TEST(ExactError, OrientationIsTheMatrixLogarithmOfTheRelativeRotation) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Situation s = situation(random, 0.05, 1e-4);
    for (const RotationModel model : {RotationModel::rxryrz, RotationModel::exponential}) {
      const Truth want = truth(s.machine, s.q, s.errors, s.C, model);
      const VolumetricError got = evaluate(s, model);
      // sin differs from the angle by its cube / 6: below 1e-9 rad for ten bodies of 1e-4 rad
      ASSERT_LE((got.orientation_work - logarithm(want.turn)).norm(), 1e-9);
      ASSERT_LE(
          (got.orientation_base - to_double(want.work_rotation * got.orientation_work.cast<Real>()))
              .norm(),
          1e-15);
    }
  }
}

// A rotation vector, not the sine of its angle: at 6 mrad they are 4e-8 rad apart.
TEST(ExactError, OrientationOfLargeErrorsIsARotationVectorToo) {
  Random random;
  for (int i = 0; i < 100; ++i) {
    const Situation s = situation(random, 0.05, 6e-3);
    for (const RotationModel model : {RotationModel::rxryrz, RotationModel::exponential}) {
      const Truth want = truth(s.machine, s.q, s.errors, s.C, model);
      ASSERT_LE((evaluate(s, model).orientation_work - logarithm(want.turn)).norm(), 1e-12);
    }
  }
}

// First order, any chain: halving all errors quarters the distance to the exact value.
TEST(FirstOrder, DistanceToTheExactErrorIsOfSecondOrder) {
  Random random;
  for (int i = 0; i < 300; ++i) {
    Situation s = situation(random, 0.0, 0.0);
    for (std::size_t a = 0; a < s.chain.axis_count(); ++a)
      s.errors[a] = random.error(0.05, 1e-4);
    const auto distance = [&](double scale) {
      ErrorSet errors = s.errors;
      for (ErrorMotion& e : errors)
        e *= scale;
      const PointPair points = ideal_points(s.chain, s.q, s.chain.tool_point());
      const VolumetricError exact =
          exact_error(s.chain, s.q, errors, Vec3::Zero(), RotationModel::rxryrz, points);
      const VolumetricError first = first_order_error(s.chain, s.q, errors, Vec3::Zero(), points);
      EXPECT_LE((exact.orientation_work - first.orientation_work).norm(), 1e-6 * scale * scale);
      return (exact.position_work - first.position_work).norm();
    };
    const double full = distance(1.0);
    if (full < 1e-9) continue;  // no or one rotating error: nothing to compare
    ASSERT_NEAR(full / distance(0.5), 4.0, 0.05) << "machine " << i;
  }
}

// The second-order model is what the tick computes: third order away from the exact one.
TEST(SecondOrder, DistanceToTheExactErrorIsOfThirdOrder) {
  Random random;
  for (int i = 0; i < 300; ++i) {
    Situation s = situation(random, 0.0, 0.0);
    for (std::size_t a = 0; a < s.chain.axis_count(); ++a)
      s.errors[a] = random.error(5.0, 1e-2);
    const auto distance = [&](double scale) {
      ErrorSet errors = s.errors;
      for (ErrorMotion& e : errors)
        e *= scale;
      const PointPair points = ideal_points(s.chain, s.q, s.chain.tool_point());
      const auto at = [&](RotationModel model) -> Vec3 {
        return exact_error(s.chain, s.q, errors, Vec3::Zero(), model, points).position_work;
      };
      return (at(RotationModel::rxryrz) - at(RotationModel::second_order)).norm();
    };
    const double full = distance(1.0);
    if (full < 1e-6) continue;
    ASSERT_NEAR(full / distance(0.5), 8.0, 1.0) << "machine " << i;
  }
}

}  // namespace
}  // namespace volcomp::test
