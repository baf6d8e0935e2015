// Lobing maps from a few directions, and the sphere they are measured on.

#include <cmath>
#include <vector>

#include "comp/metrology/fits/lobing_fit.hpp"
#include "comp/metrology/fits/sphere_fit.hpp"
#include "tests/oracle/probing_l300g.hpp"

namespace volcomp::test {
namespace {

constexpr double kRadius_um = 1493.5;
constexpr double kNoise_um = 0.1;

double normal(Random& random) {  // Box and Muller
  return std::sqrt(-2.0 * std::log(random.in(1e-12, 1.0))) * std::cos(random.in(0.0, 2.0 * kPi));
}

Vec3 anywhere(Random& random) {
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

// Evenly over the sphere: the spiral of Rakhmanov, Saff and Zhou.
std::vector<Vec3> all_round(std::size_t n) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < n; ++i) {
    const double z = -1.0 + (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(n);
    const double turn = 2.399963229728653 * static_cast<double>(i);
    const double r = std::sqrt(1.0 - z * z);
    all.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  return all;
}

std::vector<Vec3> round_the_equator(std::size_t n) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(n);
    all.emplace_back(std::cos(turn), std::sin(turn), 0.0);
  }
  return all;
}

// A probe with three arms, as switching probes have: up to ±5 µm over the directions.
double lobed_um(const Vec3& d) {
  const double azimuth = std::atan2(d.y(), d.x());
  const double across = std::hypot(d.x(), d.y());
  return kRadius_um + 3.2 * std::pow(across, 3) * std::cos(3.0 * azimuth - 0.4) +
         1.1 * across * across * std::cos(2.0 * azimuth + 1.0) + 0.7 * d.z();
}

struct Mapped {
  double raw_um = 0.0;        // largest deviation from the constant radius
  double corrected_um = 0.0;  // from the map
};

Mapped map_and_check(const std::vector<Vec3>& mapped, const std::vector<Vec3>& checked,
                     Random& random) {
  std::vector<double> radius;
  radius.reserve(mapped.size());
  for (const Vec3& d : mapped)
    radius.push_back(lobed_um(d) + kNoise_um * normal(random));
  LobingFit fit;
  EXPECT_TRUE(fit_lobing(mapped, radius, fit).ok());
  EXPECT_NEAR(fit.rms, kNoise_um, 0.5 * kNoise_um);
  Mapped m;
  for (const Vec3& d : checked) {
    m.raw_um = std::max(m.raw_um, std::abs(lobed_um(d) - kRadius_um));
    m.corrected_um = std::max(m.corrected_um, std::abs(lobed_um(d) - fit.map.radius(d)));
  }
  return m;
}

// What a mandrel or ring needs: 36 directions, ± 5 µm, 0.1 µm of noise.
TEST(Lobing, ThirtySixDirectionsMapAPlane) {
  Random random(40);
  for (int i = 0; i < 20; ++i) {
    const Mapped m = map_and_check(round_the_equator(36), round_the_equator(3600), random);
    EXPECT_LT(m.corrected_um, 0.2);
    EXPECT_GT(m.raw_um, 4.0);
    if (i == 0) RecordProperty("corrected_nm", static_cast<int>(1e3 * m.corrected_um));
  }
}

// Over the whole sphere the same number of directions has sixteen terms to determine instead of
// seven: σ √(16/36) on average, so a mean of four touches each keeps the promise everywhere.
TEST(Lobing, FourTouchesInThirtySixDirectionsMapTheSphere) {
  Random random(41);
  std::vector<Vec3> mapped;
  for (int i = 0; i < 4; ++i) {
    for (const Vec3& d : all_round(36))
      mapped.push_back(d);
  }
  std::vector<Vec3> checked;
  for (int i = 0; i < 3000; ++i)
    checked.push_back(anywhere(random));
  for (int i = 0; i < 10; ++i)
    EXPECT_LT(map_and_check(mapped, checked, random).corrected_um, 0.2);
}

TEST(Lobing, AnyMapComesBack) {
  Random random(42);
  for (int i = 0; i < 50; ++i) {
    LobingMap truth;
    for (double& c : truth.coefficient)
      c = random.in(-2.0, 2.0);
    truth.coefficient[0] = kRadius_um;
    const std::vector<Vec3> directions = all_round(36);
    std::vector<double> radius;
    for (const Vec3& d : directions)
      radius.push_back(truth.radius(d));
    LobingFit fit;
    ASSERT_TRUE(fit_lobing(directions, radius, fit).ok());
    EXPECT_EQ(fit.rank, 16);
    for (std::size_t k = 0; k < kLobingTerms; ++k)
      EXPECT_NEAR(fit.map.coefficient[k], truth.coefficient[k], 1e-9);
  }
}

// Directions in a plane know seven terms; the constant is the mean radius, not shared with others.
TEST(Lobing, TermsThatCannotBeToldApartStayZero) {
  const std::vector<Vec3> directions = round_the_equator(36);
  std::vector<double> radius;
  for (const Vec3& d : directions)
    radius.push_back(lobed_um(d));
  LobingFit fit;
  ASSERT_TRUE(fit_lobing(directions, radius, fit).ok());
  EXPECT_EQ(fit.rank, 7);
  EXPECT_NEAR(fit.map.coefficient[0], kRadius_um, 1e-9);
  EXPECT_NEAR(fit.rms, 0.0, 1e-9);
  for (std::size_t k = 0; k < kLobingTerms; ++k) {
    const bool known = (fit.known >> k & 1U) != 0;
    EXPECT_TRUE(known || std::abs(fit.map.coefficient[k]) < 1e-300) << k;
  }
  const std::vector<Vec3> one{Vec3::UnitX()};
  const std::vector<double> its{1490.0};
  ASSERT_TRUE(fit_lobing(one, its, fit).ok());
  EXPECT_EQ(fit.known, 1U);
  EXPECT_EQ(fit.map.coefficient[0], 1490.0);
}

TEST(Lobing, BadInputIsRefused) {
  std::vector<Vec3> directions = all_round(36);
  std::vector<double> radius(36, 1.5);
  LobingFit fit;
  fit.rank = -7;
  EXPECT_EQ(fit_lobing(directions, {radius.data(), 35}, fit).reason, Reason::length_mismatch);
  EXPECT_EQ(fit_lobing({}, {}, fit).reason, Reason::too_few_points);
  radius[4] = std::nan("");
  EXPECT_EQ(fit_lobing(directions, radius, fit).where.index, 4);
  radius[4] = 1.5;
  directions[9] *= 1.001;
  const Status status = fit_lobing(directions, radius, fit);
  EXPECT_EQ(status.reason, Reason::bad_setting);
  EXPECT_EQ(status.where.index, 9);
  EXPECT_EQ(fit.rank, -7);
}

// --- the sphere

TEST(SphereFit, FindsTheSphere) {
  Random random(43);
  const Vec3 centre(168.8, -30.0, 412.0);
  std::vector<Vec3> points;
  for (const Vec3& d : all_round(25))
    points.push_back(centre + 12.5 * d);
  SphereFit fit;
  ASSERT_TRUE(fit_sphere(points, fit).ok());
  EXPECT_LT((fit.sphere.centre - centre).norm(), 1e-11);
  EXPECT_NEAR(fit.sphere.radius, 12.5, 1e-11);
  EXPECT_LT(fit.rms, 1e-11);
}

// A hemisphere, as a probe reaches it: all_round of 2000 fits beside the covariance.
TEST(SphereFit, CovarianceIsTheSpread) {
  Random random(44);
  std::vector<Vec3> hemisphere;
  for (const Vec3& d : all_round(50)) {
    if (d.z() > 0.0) hemisphere.push_back(d);
  }
  constexpr double kSigma = 1e-4;
  constexpr int kFits = 2000;
  Eigen::Matrix<double, 4, 4> spread_of = Eigen::Matrix<double, 4, 4>::Zero();
  SphereFit fit;
  for (int i = 0; i < kFits; ++i) {
    std::vector<Vec3> points;
    for (const Vec3& d : hemisphere)
      points.push_back((10.0 + kSigma * normal(random)) * d);
    ASSERT_TRUE(fit_sphere(points, fit).ok());
    Eigen::Matrix<double, 4, 1> e;
    e << fit.sphere.centre, fit.sphere.radius - 10.0;
    spread_of += e * e.transpose() / kFits;
  }
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(std::sqrt(spread_of(k, k)), kSigma * std::sqrt(fit.cofactors(k, k)),
                0.08 * std::sqrt(spread_of(k, k)));
}

TEST(SphereFit, BadInputIsRefused) {
  SphereFit fit;
  fit.rms = -1.0;
  std::vector<Vec3> points(3, Vec3::Zero());
  EXPECT_EQ(fit_sphere(points, fit).reason, Reason::too_few_points);
  points.assign(9, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(fit_sphere(points, fit).reason, Reason::coincident);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = Vec3(100.0, 0.0, 3.0) * static_cast<double>(i);
  Status status = fit_sphere(points, fit);
  EXPECT_EQ(status.reason, Reason::rank_deficient);
  EXPECT_EQ(status.where.count, 2);
  points = round_the_equator(12);
  status = fit_sphere(points, fit);
  EXPECT_EQ(status.reason, Reason::rank_deficient);
  EXPECT_EQ(status.where.count, 3);
  points[7].y() = std::nan("");
  status = fit_sphere(points, fit);
  EXPECT_EQ(status.reason, Reason::not_finite);
  EXPECT_EQ(status.where.index, 7);
  EXPECT_EQ(fit.rms, -1.0);
}

}  // namespace
}  // namespace volcomp::test
