// Probe calibration on the mandrel of docs/papers/l300g.md: 162 points of a half circle.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include "comp/metrology/fits/circle_fit.hpp"

namespace volcomp::test {
namespace {

constexpr Circle kMandrel{168.8053, 0.0024, 16.4935};

struct Points {
  std::vector<double> y;
  std::vector<double> z;
};

// Steps of 0.2 mm in Y, above and below.
Points constellation() {
  Points p;
  for (int k = 0; k <= 80; ++k) {
    const double u = 0.2 * k;
    const double v = std::sqrt(kMandrel.radius * kMandrel.radius - u * u);
    for (const double side : {1.0, -1.0}) {
      p.y.push_back(kMandrel.y + u);
      p.z.push_back(kMandrel.z + side * v);
    }
  }
  return p;
}

TEST(CircleFit, FindsTheCircleOfThePaper) {
  const Points p = constellation();
  ASSERT_EQ(p.y.size(), 162U);
  CircleFit fit;
  ASSERT_TRUE(fit_circle(p.y, p.z, fit).ok());
  for (const Circle& c : {fit.kasa, fit.pratt, fit.taubin, fit.geometric}) {
    EXPECT_NEAR(c.y, kMandrel.y, 1e-11);
    EXPECT_NEAR(c.z, kMandrel.z, 1e-11);
    EXPECT_NEAR(c.radius, kMandrel.radius, 1e-11);
  }
  EXPECT_LT(fit.rms, 1e-12);
}

TEST(CircleFit, UncertaintyOfThePapersConstellation) {
  const Points p = constellation();
  CircleFit fit;
  ASSERT_TRUE(fit_circle(p.y, p.z, fit).ok());
  const Mat3& q = fit.cofactors;
  EXPECT_NEAR(std::sqrt(q(0, 0)), 0.277, 0.0005);
  EXPECT_NEAR(std::sqrt(q(1, 1)), 0.095, 0.0005);
  EXPECT_NEAR(std::sqrt(q(2, 2)), 0.156, 0.0005);
  EXPECT_NEAR(q(0, 2) / std::sqrt(q(0, 0) * q(2, 2)), -0.86, 0.005);
}

TEST(CircleFit, NamesTheWorstPoint) {
  Points p = constellation();
  p.z[40] += 0.05;
  CircleFit fit;
  ASSERT_TRUE(fit_circle(p.y, p.z, fit).ok());
  EXPECT_EQ(fit.worst, 40U);
  EXPECT_GT(fit.largest, 0.03);
}

// Where the geometric fit stands still, no neighbour has a smaller sum of squares.
TEST(CircleFit, GeometricFitIsAMinimum) {
  Points p = constellation();
  for (std::size_t i = 0; i < p.y.size(); ++i)
    p.z[i] += 0.003 * std::sin(1.7 * static_cast<double>(i));
  CircleFit fit;
  ASSERT_TRUE(fit_circle(p.y, p.z, fit).ok());
  const auto sum = [&](const Circle& c) {
    double total = 0.0;
    for (std::size_t i = 0; i < p.y.size(); ++i)
      total += std::pow(std::hypot(p.y[i] - c.y, p.z[i] - c.z) - c.radius, 2);
    return total;
  };
  const Circle best = fit.geometric;
  for (const double step : {1e-6, -1e-6}) {
    EXPECT_LT(sum(best), sum({best.y + step, best.z, best.radius}));
    EXPECT_LT(sum(best), sum({best.y, best.z + step, best.radius}));
    EXPECT_LT(sum(best), sum({best.y, best.z, best.radius + step}));
  }
}

TEST(CircleFit, RefusalLeavesTheOldFit) {
  CircleFit fit;
  fit.rms = 7.0;
  const std::vector<double> line{0.0, 1.0, 2.0, 3.0};
  EXPECT_EQ(fit_circle(line, line, fit).reason, Reason::collinear);
  const std::vector<double> holed{0.0, NAN, 2.0, 1.0};
  const Status status = fit_circle(line, holed, fit);
  EXPECT_EQ(status.reason, Reason::not_finite);
  EXPECT_EQ(status.where.index, 1);
  EXPECT_EQ(fit.rms, 7.0);
}

}  // namespace
}  // namespace volcomp::test
