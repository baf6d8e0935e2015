// Pitch and cross tables: what a per-axis controller can represent, and what it cannot.

#include <memory>

#include <gtest/gtest.h>

#include "tests/oracle/exact_chain.hpp"
#include "tests/oracle/per_axis_anchored.hpp"

namespace volcomp::test {
namespace {

constexpr std::array<KnotGrid, 3> kGrid{KnotGrid{-500.0, 50.0, 11}, KnotGrid{-300.0, 60.0, 6},
                                        KnotGrid{-400.0, 50.0, 9}};
constexpr std::size_t kCapacity = 16;
using Tables = PerAxisTables<kCapacity>;

// Six random functions of each axis, given at the knots.
struct Functions {
  explicit Functions(Random& random) {
    for (auto& axis : e) {
      for (ErrorMotion& at_knot : axis)
        at_knot = random.error(0.01, 3e-5);
    }
  }
  std::array<std::array<ErrorMotion, kCapacity>, 3> e;
};

std::size_t knot_of(std::size_t axis, double q) {
  return static_cast<std::size_t>(std::lround((q - kGrid[axis].q0) / kGrid[axis].pitch));
}

// Sum over the three axes at a grid point.
Vec3 table_value(const Tables& t, const Vec3& q) {
  return t.constant + t.f[0][knot_of(0, q.x())] + t.f[1][knot_of(1, q.y())] +
         t.f[2][knot_of(2, q.z())];
}

template <class Visit>
void visit_grid(const Visit& visit) {
  for (std::size_t i = 0; i < kGrid[0].knots; ++i) {
    for (std::size_t j = 0; j < kGrid[1].knots; ++j) {
      for (std::size_t k = 0; k < kGrid[2].knots; ++k)
        visit(Vec3(kGrid[0].at(i), kGrid[1].at(j), kGrid[2].at(k)));
    }
  }
}

TEST(PerAxis, RepresentsSumsOfOneAxisFunctionsExactly) {
  Random random;
  const Functions f(random);
  const auto error = [&](const Vec3& q) -> Vec3 {
    return translation(f.e[0][knot_of(0, q.x())]) + translation(f.e[1][knot_of(1, q.y())]) +
           translation(f.e[2][knot_of(2, q.z())]);
  };
  Tables mean;
  Tables anchored;
  per_axis_grid_mean(error, kGrid, mean);
  per_axis_anchored(error, kGrid, Vec3(-250, -120, -200), anchored);
  visit_grid([&](const Vec3& q) {
    ASSERT_LE((table_value(mean, q) - error(q)).norm(), 1e-16);
    ASSERT_LE((table_value(anchored, q) - error(q)).norm(), 1e-16);
  });
  EXPECT_LE(mean.residual_max.maxCoeff(), 1e-16);
  EXPECT_LE(anchored.residual_rms, 1e-16);
}

// The part of the XYFZ model no per-axis table holds: six products of an angle and a length.
struct Products {
  const Functions& f;
  Vec3 q_mean = Vec3::Zero();
  std::array<Vec3, 2> angle_mean{Vec3::Zero(), Vec3::Zero()};

  explicit Products(const Functions& functions) : f(functions) {
    for (std::size_t a = 0; a < 3; ++a) {
      const KnotGrid& g = kGrid[a];
      q_mean(static_cast<Eigen::Index>(a)) = 0.5 * (g.at(0) + g.at(g.knots - 1));
    }
    for (std::size_t a = 0; a < 2; ++a) {
      for (std::size_t i = 0; i < kGrid[a].knots; ++i)
        angle_mean[a] += rotation(f.e[a][i]) / static_cast<double>(kGrid[a].knots);
    }
  }
  // x: ε_yX Z, ε_zX Y, ε_yY Z; y: ε_xX Z, ε_xY Z; z: ε_xX Y
  [[nodiscard]] Vec3 products(const Vec3& x, const Vec3& y, const Vec3& l) const {
    return {(x.y() + y.y()) * l.z() - x.z() * l.y(), -(x.x() + y.x()) * l.z(), x.x() * l.y()};
  }
  [[nodiscard]] Vec3 angle(std::size_t axis, double q) const {
    return rotation(f.e[axis][knot_of(axis, q)]);
  }
  [[nodiscard]] Vec3 error(const Vec3& q) const {
    return translation(f.e[0][knot_of(0, q.x())]) + translation(f.e[1][knot_of(1, q.y())]) +
           translation(f.e[2][knot_of(2, q.z())]) + products(angle(0, q.x()), angle(1, q.y()), q);
  }
  // Σ (ε_i − mean) × (q_j − mean)
  [[nodiscard]] Vec3 not_representable(const Vec3& q) const {
    return products(angle(0, q.x()) - angle_mean[0], angle(1, q.y()) - angle_mean[1], q - q_mean);
  }
};

TEST(PerAxis, GridMeanLeavesExactlyTheSixCentredProducts) {
  Random random;
  const Functions f(random);
  const Products model(f);
  Tables t;
  per_axis_grid_mean([&](const Vec3& q) { return model.error(q); }, kGrid, t);
  Vec3 largest = Vec3::Zero();
  double squares = 0.0;
  visit_grid([&](const Vec3& q) {
    const Vec3 rest = model.error(q) - table_value(t, q);
    ASSERT_LE((rest - model.not_representable(q)).norm(), 1e-15);
    largest = largest.cwiseMax(rest.cwiseAbs());
    squares += rest.squaredNorm();
  });
  EXPECT_LE((t.residual_max - largest).norm(), 1e-16);
  EXPECT_NEAR(t.residual_rms, std::sqrt(squares / (3.0 * 11.0 * 6.0 * 9.0)), 1e-15);
  EXPECT_GT(t.residual_max.x(), 1e-3);
}

// Least squares: no change of any table entry makes the sum of squares smaller.
TEST(PerAxis, GridMeanIsTheLeastSquaresOptimum) {
  Random random;
  const auto error = [&](const Vec3& q) -> Vec3 {
    return {std::sin(0.01 * q.x() * 0.02 * q.y()), std::cos(q.z() * 0.01) * q.x() * 1e-3,
            std::sin(1e-5 * q.x() * q.y() + 0.01 * q.z())};
  };
  auto t = std::make_unique<Tables>();
  per_axis_grid_mean(error, kGrid, *t);
  const auto squares = [&](const Tables& tables) {
    double sum = 0.0;
    visit_grid([&](const Vec3& q) { sum += (error(q) - table_value(tables, q)).squaredNorm(); });
    return sum;
  };
  const double best = squares(*t);
  for (int i = 0; i < 50; ++i) {
    Tables other = *t;
    const auto axis = static_cast<std::size_t>(random.integer(0, 2));
    const auto knot =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(kGrid[axis].knots) - 1));
    other.f[axis][knot] += random.vector(1e-3);
    ASSERT_GT(squares(other), best);
  }
}

// Tables read off along three lines are exact on them, and the products are taken about the anchor.
TEST(PerAxis, AnchoredTablesAreExactOnTheirLines) {
  Random random;
  const Functions f(random);
  const Products model(f);
  const Vec3 anchor(-250.0, -120.0, -200.0);
  Tables t;
  per_axis_anchored([&](const Vec3& q) { return model.error(q); }, kGrid, anchor, t);
  const Vec3 x0 = model.angle(0, anchor.x());
  const Vec3 y0 = model.angle(1, anchor.y());
  Vec3 largest = Vec3::Zero();
  visit_grid([&](const Vec3& q) {
    const Vec3 rest = model.error(q) - table_value(t, q);
    const Vec3 want =
        model.products(model.angle(0, q.x()) - x0, model.angle(1, q.y()) - y0, q - anchor);
    ASSERT_LE((rest - want).norm(), 1e-15);
    const Vec3 off = (q - anchor).cwiseAbs();
    if ((off.array() > 0.0).count() <= 1) {
      ASSERT_LE(rest.norm(), 1e-16);
    }
    largest = largest.cwiseMax(rest.cwiseAbs());
  });
  EXPECT_LE((t.residual_max - largest).norm(), 1e-16);
}

}  // namespace
}  // namespace volcomp::test
