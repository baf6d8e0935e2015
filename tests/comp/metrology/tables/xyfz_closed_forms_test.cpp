// The XYFZ machine of the paper: its equations in closed form (docs/papers/xyfz.md).

#include <algorithm>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "comp/machine/xyfz.hpp"
#include "comp/metrology/tables/abbe.hpp"
#include "comp/metrology/tables/diagonals.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

using Relative = std::array<ErrorMotion, 3>;  // X, Y, Z

struct Xyfz {
  Vec3 b12;
  Vec3 b03;
  Vec3 tip;
  Vec3 q;
  XyfzSquareness squareness;
  Relative e;

  // Head → functional point.
  [[nodiscard]] std::array<Vec3, 3> arms() const {
    const Vec3 c_y = b03 + tip;
    const Vec3 c_x = c_y - b12;
    return {Vec3(c_x + q), Vec3(c_y + Vec3(0, q.y(), q.z())), tip};
  }
  [[nodiscard]] Vec3 C() const {
    return {q.z() * squareness.a_xz, q.x() * squareness.a_xy - q.z() * squareness.a_yz, 0.0};
  }
  [[nodiscard]] Vec3 first_order() const {
    Vec3 E = C();
    for (std::size_t i = 0; i < 3; ++i)
      E += translation(e[i]) + rotation(e[i]).cross(arms()[i]);
    return E;
  }
};

std::array<double, 3> plain(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Xyfz random_xyfz(Random& random, double mm, double rad) {
  return {random.vector(300.0),
          random.vector(400.0),
          random.vector(250.0),
          {random.uniform(-500, 0), random.uniform(-300, 0), random.uniform(-400, 0)},
          {random.uniform(-3e-4, 3e-4), random.uniform(-3e-4, 3e-4), random.uniform(-3e-4, 3e-4)},
          {random.error(mm, rad), random.error(mm, rad), random.error(mm, rad)}};
}

struct Answer {
  Vec3 first;
  VolumetricError small;  // I + [e]x, the paper's matrices
  VolumetricError rigid;
};

Answer evaluate(const MachineChain& chain, const Xyfz& x, const Vec3& C) {
  const Pose q{x.q.x(), x.q.y(), x.q.z()};
  ErrorSet errors = zero_errors();
  for (std::size_t a = 0; a < 3; ++a)
    errors[a] = to_internal(x.e[a], chain.axis(a), q[a], Convention::relative, Side::moving);
  const PointPair points = ideal_points(chain, q, x.tip);
  return {first_order_error(chain, q, errors, C, points).position_base,
          exact_error(chain, q, errors, C, RotationModel::linear, points),
          exact_error(chain, q, errors, C, RotationModel::rxryrz, points)};
}

Answer optimised(const Xyfz& x) {
  const MachineChain chain = chain_of(xyfz_optimised({plain(x.b12), plain(x.b03), plain(x.tip)}));
  const Pose q{x.q.x(), x.q.y(), x.q.z()};
  return evaluate(chain, x, squareness_translation(chain, q, xyfz_directions(x.squareness)));
}

Vec3 naive(const Xyfz& x) {
  return evaluate(chain_of(xyfz_naive(x.squareness, plain(x.tip))), x, Vec3::Zero()).first;
}

TEST(XyfzOptimised, FirstOrderIsTheSumOfErrorsAndLevers) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const Xyfz x = random_xyfz(random, 0.05, 1e-4);
    ASSERT_LE((optimised(x).first - x.first_order()).norm(), 2e-13);
  }
}

// Exact eq. 11–13 = E1 − ε_Y × (δ_X + ε_X × r_X): one mixed product, nothing else.
TEST(XyfzOptimised, ExactEquationsAddOneMixedProduct) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const Xyfz x = random_xyfz(random, 0.05, 1e-4);
    const Vec3 mixed =
        rotation(x.e[1]).cross(translation(x.e[0]) + rotation(x.e[0]).cross(x.arms()[0]));
    ASSERT_LE((optimised(x).small.position_base - (x.first_order() - mixed)).norm(), 2e-13);
  }
}

// Second order in closed form: the turned work frame, the mixed product and half the squares.
double second_order_bound(const Xyfz& x) {
  const auto turn = [&](std::size_t k) { return rotation(x.e[k]).norm(); };
  double bound = (turn(0) + turn(1)) * x.first_order().norm();
  bound += turn(1) * (translation(x.e[0]) + rotation(x.e[0]).cross(x.arms()[0])).norm();
  for (std::size_t k = 0; k < 3; ++k)
    bound += 0.5 * turn(k) * turn(k) * x.arms()[k].norm();
  return bound;
}

// Distances of the first-order model from the rigid chain in the work frame, squareness of the
// paper (Table 6), arms up to 1.2 m, ascending.
std::vector<double> distances(Random& random, double mm, double rad) {
  std::vector<double> found;
  while (found.size() < 5000) {
    Xyfz x = random_xyfz(random, mm, rad);
    x.squareness = {127.264e-6, 222.190e-6, 17.356e-6};
    for (ErrorMotion& e : x.e)
      e.tail<3>() *= rad / std::max(rad, rotation(e).norm());
    if (x.arms()[0].norm() > 1200.0 || x.arms()[1].norm() > 1200.0) continue;
    const Answer a = optimised(x);
    found.push_back((a.rigid.position_work - a.first).norm());
    EXPECT_LE(found.back(), 1.001 * second_order_bound(x) + 1e-12);
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Conventions, section 4: about 10 nm at 4e-5 rad and 32 nm at 1e-4 rad. These are no upper bounds:
// the worst of the sample is beyond them, 19 in 20 are below.
TEST(XyfzOptimised, DistanceOfTheFirstOrderModelFromTheRigidChain) {
  Random random;
  const std::vector<double> small = distances(random, 0.02, 4e-5);
  const std::vector<double> large = distances(random, 0.02, 1e-4);
  RecordProperty("worst_pm_at_4e-5_rad", static_cast<int>(1e9 * small.back()));
  RecordProperty("worst_pm_at_1e-4_rad", static_cast<int>(1e9 * large.back()));
  EXPECT_LE(small[small.size() * 19 / 20], 10e-6);
  EXPECT_LE(large[large.size() * 19 / 20], 32e-6);
}

// The naive model, P_w tracking: r_X = P_t + (X,Y,Z), r_Y = P_t + (0,Y,Z), r_Z = P_t; squareness as
// rotations.
TEST(XyfzNaive, ClosedForm) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Xyfz x = random_xyfz(random, 0.05, 1e-4);
    const Vec3 yz(0, x.q.y(), x.q.z());
    const Vec3 z(0, 0, x.q.z());
    const XyfzSquareness& s = x.squareness;
    Vec3 want = Vec3(0, 0, -s.a_xy).cross(x.tip + yz) + Vec3(s.a_yz, s.a_xz, 0).cross(x.tip + z);
    const std::array<Vec3, 3> arm{Vec3(x.tip + x.q), Vec3(x.tip + yz), x.tip};
    for (std::size_t k = 0; k < 3; ++k)
      want += translation(x.e[k]) + rotation(x.e[k]).cross(arm[k]);
    ASSERT_LE((naive(x) - want).norm(), 2e-13);
  }
}

// What naive misses: values measured at L, used as if measured at the machine zero point, leave
// Σ ε_i × k_i, k_i = r_i − L_i − r_i(naive).
TEST(XyfzNaive, MissesTheAnglesTimesTheForgottenLevers) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    Xyfz x = random_xyfz(random, 0.05, 1e-4);
    x.squareness = {};
    const Vec3 yz(0, x.q.y(), x.q.z());
    const std::array<Vec3, 3> naive_arm{Vec3(x.tip + x.q), Vec3(x.tip + yz), x.tip};
    Xyfz measured = x;
    Vec3 missed = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const int kappa = random.integer(-1, 1);
      const SensedPoint point{random.vector(600.0), kappa};
      const Vec3 L = point.lever(static_cast<Axis>(k), x.q(static_cast<Eigen::Index>(k)));
      measured.e[k] = at_lever(x.e[k], L);
      missed += rotation(x.e[k]).cross(x.arms()[k] - L - naive_arm[k]);
    }
    ASSERT_LE((optimised(x).first - naive(measured) - missed).norm(), 4e-13);
  }
}

// Squareness as rotations (eq. 1–3) and as a translation (eq. 10) differ by a rigid rotation and a
// constant: every diagonal is the same.
TEST(XyfzNaive, SquarenessAsRotationsIsTheSameOnEveryDiagonal) {
  Random random;
  Xyfz x = random_xyfz(random, 0.0, 0.0);
  const auto rotations = [&](const Vec3& q) {
    x.q = q;
    return naive(x);
  };
  const auto shift = [&](const Vec3& q) {
    x.q = q;
    return x.C();
  };
  EXPECT_GT((rotations({-500, -300, -400}) - shift({-500, -300, -400})).norm(), 1e-3);
  for (const Diagonal& d : body_diagonals({{-500, -300, -400}, {0, 0, 0}})) {
    std::array<double, 11> a{};
    std::array<double, 11> b{};
    DiagonalFigures figures;
    ASSERT_TRUE(diagonal_deviations(rotations, d, a, figures).ok());
    ASSERT_TRUE(diagonal_deviations(shift, d, b, figures).ok());
    for (std::size_t j = 0; j < a.size(); ++j)
      EXPECT_NEAR(a[j], b[j], 2e-13) << d.name;
  }
}

// The reading head cancels: the same motion measured at another place, or referred to another point
// of the body, is the same volumetric error.
TEST(ReadingHead, MeasuringAtAnotherPlaceChangesNothing) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const ErrorMotion head = random.error(0.05, 1e-4);
    const double q = random.uniform(-500, 0);
    for (const int kappa : {-1, 0, 1}) {
      const Axis axis = random.pick({Axis::x, Axis::y, Axis::z});
      const Vec3 here = SensedPoint{random.vector(600.0), kappa}.lever(axis, q);
      const Vec3 there = SensedPoint{random.vector(600.0), kappa}.lever(axis, q);
      const ErrorMotion m = at_lever(head, here);
      ErrorMotion m_there = m;
      m_there.head<3>() += rotation(m).cross(there - here);
      ASSERT_LE((at_head(m_there, there) - head).norm(), 1e-15);
    }
  }
}

TEST(ReadingHead, AnyBodyFixedOriginGivesTheSameError) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Xyfz x = random_xyfz(random, 0.05, 1e-4);
    const Vec3 s = random.vector(300.0);
    Xyfz moved = x;  // the X head moved by s on its body
    moved.b12 += s;
    moved.e[0] = at_lever(x.e[0], s);
    ASSERT_LE((optimised(moved).first - optimised(x).first).norm(), 4e-13);
    moved = x;  // the Z head
    moved.b03 += s;
    moved.tip -= s;
    moved.e[2] = at_lever(x.e[2], s);
    ASSERT_LE((optimised(moved).first - optimised(x).first).norm(), 4e-13);
  }
}

// Eq. (10) with a_xy of the wrong sign is 127 µm off in E_y at X = −500 (docs/papers/xyfz.md, "What
// is wrong in it").
TEST(XyfzOptimised, SquarenessSignOfThePaper) {
  const DirectionErrors d = xyfz_directions({127.264e-6, 222.190e-6, 17.356e-6});
  const MachineChain chain = chain_of(xyfz_optimised({{}, {}, {}}));
  const Vec3 C = squareness_translation(chain, {-500, -300, -400}, d);
  EXPECT_NEAR(C.x(), -0.088876, 1e-9);
  EXPECT_NEAR(C.y(), -0.0566896, 1e-9);
  EXPECT_EQ(C.z(), 0.0);
}

}  // namespace
}  // namespace volcomp::test
