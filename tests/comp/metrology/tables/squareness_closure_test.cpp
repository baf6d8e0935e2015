// Squareness closure (docs/papers/xyfz.md, "What we do"): unit gain, one step, blind to
// conventions, and only a rigid rotation stays undetermined.

#include <gtest/gtest.h>

#include "comp/metrology/tables/diagonals.hpp"
#include "comp/metrology/tables/plausibility.hpp"
#include "comp/metrology/tables/squareness.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

const XyfzSquareness kPaper{127.264e-6, 222.190e-6, 17.356e-6};    // Table 6
DiagonalBox strokes() { return {{-500, -300, -400}, {0, 0, 0}}; }  // Table 5

Vec3 C(const XyfzSquareness& s, const Vec3& q) {
  return {q.z() * s.a_xz, q.x() * s.a_xy - q.z() * s.a_yz, 0.0};
}

// Waves in every channel with the levers of the XYFZ machine, plus what a commissioning may choose
// freely: straightness slopes and constant angles.
struct Model {
  std::array<ErrorMotion, 3> amplitude;
  std::array<ErrorMotion, 3> phase;
  Mat3 slope = Mat3::Zero();                                            // [component](axis)
  std::array<Vec3, 3> angle{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // constant part
  XyfzSquareness parameter;

  [[nodiscard]] Vec3 operator()(const Vec3& q) const {
    const std::array<Vec3, 3> arm{Vec3(Vec3(250, 290, 650) + q),
                                  Vec3(Vec3(50, 140, 830) + Vec3(0, q.y(), q.z())),
                                  Vec3(30, -380, -300)};
    Vec3 E = C(parameter, q) + slope * q;
    for (std::size_t a = 0; a < 3; ++a) {
      ErrorMotion e;
      for (Eigen::Index c = 0; c < 6; ++c)
        e(c) = amplitude[a](c) * std::sin(0.01 * q(static_cast<Eigen::Index>(a)) + phase[a](c));
      E += translation(e) + (rotation(e) + angle[a]).cross(arm[a]);
    }
    return E;
  }
};

Model random_model(Random& random) {
  Model m;
  for (std::size_t a = 0; a < 3; ++a) {
    m.amplitude[a] = random.error(5e-3, 2e-5);
    m.phase[a] = random.error(3.0, 3.0);
  }
  return m;
}

class Closure : public ::testing::Test {
 protected:
  std::vector<double> x{-400, -300, -200, -100};
  std::vector<double> y{-270, -190, -110, -30};
  std::vector<double> z{-390, -310, -230, -150};

  [[nodiscard]] XyfzSquareness apparent(const Model& m) const {
    return apparent_squareness(m, {Vec3(-250, -150, -300), x, y, z});
  }
  [[nodiscard]] Model closed(Model m, const XyfzSquareness& measured) const {
    m.parameter = {};
    m.parameter = close_squareness(measured, apparent(m));
    return m;
  }
};

double largest_difference(const Model& a, const Model& b) {
  double worst = 0.0;
  for (const Diagonal& d : body_diagonals(strokes())) {
    std::array<double, 37> da{};
    std::array<double, 37> db{};
    DiagonalFigures figures;
    EXPECT_TRUE(diagonal_deviations(a, d, da, figures).ok());
    EXPECT_TRUE(diagonal_deviations(b, d, db, figures).ok());
    for (std::size_t j = 0; j < 37; ++j)
      worst = std::max(worst, std::abs(da[j] - db[j]));
  }
  return worst;
}

TEST_F(Closure, ApparentSquarenessIsTheParameterWithUnitGain) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    Model m = random_model(random);
    const XyfzSquareness before = apparent(m);
    m.parameter = {random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3),
                   random.uniform(-1e-3, 1e-3)};
    const XyfzSquareness after = apparent(m);
    EXPECT_NEAR(after.a_xy - before.a_xy, m.parameter.a_xy, 1e-17);
    EXPECT_NEAR(after.a_xz - before.a_xz, m.parameter.a_xz, 1e-17);
    EXPECT_NEAR(after.a_yz - before.a_yz, m.parameter.a_yz, 1e-17);
  }
}

TEST_F(Closure, OneStepMakesTheModelShowWhatWasMeasured) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const XyfzSquareness shown = apparent(closed(random_model(random), kPaper));
    EXPECT_NEAR(shown.a_xy, kPaper.a_xy, 1e-17);
    EXPECT_NEAR(shown.a_xz, kPaper.a_xz, 1e-17);
    EXPECT_NEAR(shown.a_yz, kPaper.a_yz, 1e-17);
  }
}

// Other straightness slopes, other zeros of the angles: the closed models agree on every diagonal.
// What differs is one rigid rotation and a constant.
TEST_F(Closure, SlopesAndAngleZerosLeaveARigidMotionOnly) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const Model a = random_model(random);
    Model b = a;
    for (Eigen::Index c = 0; c < 3; ++c) {
      b.slope.col(c) = random.vector(2e-4);
      b.slope(c, c) = 0.0;  // positioning is no free choice
      b.angle[static_cast<std::size_t>(c)] = random.vector(1e-4);
    }
    EXPECT_GT(largest_difference(a, b), 1e-3);
    const Model ca = closed(a, kPaper);
    const Model cb = closed(b, kPaper);
    EXPECT_LE(largest_difference(ca, cb), 1e-15 * 1e3);

    const auto change = [&](const Vec3& q) -> Vec3 { return cb(q) - ca(q); };
    const Vec3 shift = change(Vec3::Zero());
    Mat3 gradient;
    for (Eigen::Index c = 0; c < 3; ++c)
      gradient.col(c) = (change(100.0 * Vec3::Unit(c)) - shift) / 100.0;
    EXPECT_LE((gradient + gradient.transpose()).cwiseAbs().maxCoeff(), 1e-16);
    EXPECT_GT(gradient.cwiseAbs().maxCoeff(), 1e-6);  // not repaired, and not seen
    const Vec3 q(-321, -123, -222);
    EXPECT_LE((change(q) - shift - gradient * q).norm(), 1e-13);
  }
}

// A slope that contains the squareness, plus the squareness, is 39 µm off on PNP and 93 µm on the
// worst diagonal; the closure finds that nothing is left to add.
TEST_F(Closure, DoubleCountingCostsTensOfMicrometresAndIsRepaired) {
  Model once;  // squareness in the straightness slopes, where it was measured
  for (std::size_t a = 0; a < 3; ++a)
    once.amplitude[a] = once.phase[a] = ErrorMotion::Zero();
  once.slope(1, 0) = kPaper.a_xy;
  once.slope(0, 2) = kPaper.a_xz;
  once.slope(1, 2) = -kPaper.a_yz;
  Model twice = once;
  twice.parameter = kPaper;
  EXPECT_NEAR(largest_difference(once, twice), 92.8e-3, 0.05e-3);
  std::array<double, 11> pnp{};
  DiagonalFigures figures;
  const auto excess = [&](const Vec3& q) -> Vec3 { return twice(q) - once(q); };
  ASSERT_TRUE(diagonal_deviations(excess, body_diagonals(strokes())[2], pnp, figures).ok());
  EXPECT_NEAR(figures.max_abs, 39e-3, 0.5e-3);
  EXPECT_LE(largest_difference(once, closed(twice, kPaper)), 1e-15);
}

// --- entered parameters -----------------------------------------------------------------------

TEST(Plausibility, SquarenessInArcSecondsIsCaught) {
  EXPECT_TRUE(check_squareness("a", {127e-6, -5e-3, 5e-3}).ok());
  const Status s = check_squareness("a", {127e-6, 5.001e-3, 26.25});
  EXPECT_EQ(s.reason, Reason::unit_suspected);
  EXPECT_STREQ(s.where.field, "a");
  EXPECT_EQ(s.where.index, 1);
  EXPECT_EQ(check_squareness("a", {0, 0, std::nan("")}).reason, Reason::not_finite);
}

TEST(Plausibility, OffsetsInMetresOrMicrometresAreCaught) {
  EXPECT_TRUE(check_offset("b", {0, 0, 0}).ok());
  EXPECT_TRUE(check_offset("b", {0.1, 1.0, 5000}).ok());
  EXPECT_EQ(check_offset("b", {0.2, -0.15, 0.18}).reason, Reason::unit_suspected);
  EXPECT_EQ(check_offset("b", {0, 0, -5001}).reason, Reason::unit_suspected);
  EXPECT_EQ(check_offset("b", {0, 0, -5001}).where.index, 2);
  EXPECT_EQ(check_offset("b", {0, std::nan(""), 1}).reason, Reason::not_finite);
}

TEST(Plausibility, LimitsMustBePositive) {
  EXPECT_TRUE(check_positive("limit", 1e-9).ok());
  EXPECT_EQ(check_positive("limit", 0.0).reason, Reason::bad_setting);
  EXPECT_EQ(check_positive("limit", -1.0).reason, Reason::bad_setting);
  EXPECT_EQ(check_positive("limit", std::nan("")).reason, Reason::not_finite);
}

}  // namespace
}  // namespace volcomp::test
