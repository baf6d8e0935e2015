// What a probe does by direction, and that a calibration on a sphere finds it.

#include "host_sim/sim/instruments/probe_signature.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "comp/core/units.hpp"
#include "host_sim/sim/instruments/probe_class.hpp"

namespace volcomp::sim {
namespace {

constexpr double kEffective_mm = 1.4935;
constexpr std::size_t kLp2 = 2;

TouchNoise without_scatter() {
  TouchNoise noise = touch_noise(kProbeClasses[kLp2], 7);
  noise.repeatability_2s = 0.0;
  noise.hysteresis = 0.0;
  return noise;
}

std::vector<Vec3> all_over() {
  std::vector<Vec3> all;
  for (int e = -80; e <= 80; e += 20) {
    for (int a = 0; a < 360; a += 17) {
      const double up = e * kPi / 180.0;
      const double round = a * kPi / 180.0;
      all.emplace_back(std::cos(up) * std::cos(round), std::cos(up) * std::sin(round),
                       std::sin(up));
    }
  }
  return all;
}

// Three lobes of 2 µm across the stylus; along it 5.85 N bend it by less than 0.65 N across it.
TEST(ProbeSignature, HasLobesRoundTheStylusWhereverThatPoints) {
  for (const Vec3& stylus : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
    const ProbeSignature probe(without_scatter(), stylus);
    EXPECT_NEAR(probe.by_direction(stylus), -5.85 / 5000.0, 1e-15);
    const Vec3 aside = stylus.unitOrthogonal();
    double least = 1.0;
    double most = -1.0;
    double sum = 0.0;
    constexpr int kSteps = 360;
    for (int k = 0; k < kSteps; ++k) {
      const Vec3 n = Eigen::AngleAxisd(2.0 * kPi * k / kSteps, stylus) * aside;
      const double r = probe.by_direction(n);
      EXPECT_NEAR(r, probe.by_direction(Eigen::AngleAxisd(2.0 * kPi / 3.0, stylus) * n), 1e-15);
      least = std::min(least, r);
      most = std::max(most, r);
      sum += r;
    }
    EXPECT_NEAR(kUmPerMm * (most - least), 4.0, 0.001);
    EXPECT_NEAR(sum / kSteps, -0.65 / 60.0, 1e-12);
  }
}

// Lobes of third order and a bending of second order are within the sixteen terms of the map.
TEST(ProbeSignature, ACalibrationWithoutScatterFindsItExactly) {
  const ProbeSignature probe(without_scatter(), Vec3::UnitX());
  const LobingMap map = calibrated_on_sphere(probe, kEffective_mm, {});
  for (const Vec3& n : all_over())
    EXPECT_NEAR(map.radius(n), kEffective_mm + probe.bent_across() + probe.by_direction(n), 1e-12);
}

// Thirteen terms from 36 directions of five touches each leave σ √(13/36) / √5 of a radius, over
// the directions; here over 20 calibrations.
TEST(ProbeSignature, ACalibrationWithScatterIsAsGoodAsItsTouches) {
  double squares = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TouchNoise noise = touch_noise(kProbeClasses[kLp2], seed);
    noise.hysteresis = 0.0;
    const ProbeSignature probe(noise, Vec3::UnitZ());
    const LobingMap map = calibrated_on_sphere(probe, kEffective_mm, {seed, 0});
    for (const Vec3& n : all_over()) {
      if (std::abs(n.z()) > 0.9) continue;  // beyond the rings
      const double off =
          map.radius(n) - kEffective_mm - probe.bent_across() - probe.by_direction(n);
      squares += off * off;
      ++count;
    }
  }
  const double rms_um = kUmPerMm * std::sqrt(squares / count);
  const double expected_um = 0.5 * std::sqrt(13.0 / 36.0) / std::sqrt(5.0);
  EXPECT_NEAR(rms_um, expected_um, 0.25 * expected_um);
}

TEST(ProbeSignature, AProbeWithoutErrorsAddsNothing) {
  const ProbeSignature probe(touch_noise(kProbeClasses[0], 1), Vec3::UnitX());
  for (const Vec3& n : all_over())
    EXPECT_NEAR(probe.by_direction(n), 0.0, 1e-300);
  EXPECT_NEAR(probe.bent_across(), 0.0, 1e-300);
}

}  // namespace
}  // namespace volcomp::sim
