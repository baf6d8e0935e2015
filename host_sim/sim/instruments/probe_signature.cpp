#include "host_sim/sim/instruments/probe_signature.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/machine/frame.hpp"
#include "comp/metrology/fits/lobing_fit.hpp"
#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/sim/instruments/probe_class.hpp"

namespace volcomp::sim {
namespace {

// Third order needs seven directions of a ring, and four rings.
constexpr int kAround = 9;
constexpr std::array<double, 4> kElevations_deg{-60.0, -20.0, 20.0, 60.0};

std::vector<Vec3> directions() {
  std::vector<Vec3> all;
  for (const double elevation : kElevations_deg) {
    for (int i = 0; i < kAround; ++i) {
      const double azimuth = 2.0 * kPi * i / kAround;
      const double up = elevation * kPi / 180.0;
      all.emplace_back(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth),
                       std::sin(up));
    }
  }
  return all;
}

// Rodrigues' formula: I + [v] + [v]² / (1 + c), v = from × z, c = from · z. Not for −z.
Mat3 shortest_turn_to_z(const Vec3& from) {
  const Mat3 v = cross_matrix(from.cross(Vec3::UnitZ()));
  return Mat3::Identity() + v + v * v / (1.0 + from.z());
}

}  // namespace

std::string probe_text(const ProbeClass& probe) {
  return fmt::format(
      "2σ = {:g} µm in one direction, lobes of {:g} µm, hysteresis of {:g} µm, a bending stylus",
      probe.repeatability_2s_um, probe.lobing_um, probe.hysteresis_um);
}

TouchNoise touch_noise(const ProbeClass& probe, std::uint64_t seed) {
  TouchNoise noise;
  noise.repeatability_2s = probe.repeatability_2s_um / kUmPerMm;
  noise.lobe3 = probe.lobing_um / kUmPerMm;
  noise.hysteresis = probe.hysteresis_um / kUmPerMm;
  noise.force_xy = probe.force_across_N;
  noise.force_z = probe.force_along_N;
  noise.stiffness_xy = probe.stiffness_across_N_mm;
  noise.stiffness_z = probe.stiffness_along_N_mm;
  const RandomIndex at{static_cast<std::uint32_t>(RandomStream::lobing), 0, kCommon, kCommon};
  noise.lobe3_angle = 2.0 * kPi * uniforms(seed, at).u;
  return noise;
}

ProbeSignature::ProbeSignature(const TouchNoise& touches, const Vec3& stylus)
    : noise(touches), to_probe(shortest_turn_to_z(stylus)) {}

double ProbeSignature::by_direction(const Vec3& normal) const {
  const Vec3 n = to_probe * normal;
  return noise.lobing(n) + noise.bending(n);
}

void ProbeSignature::give_to(TouchProbe::Settings& probe) const {
  probe.radius_mm += bent_across();
  probe.lobing_mm = [signature = *this](const Vec3& n) { return signature.by_direction(n); };
  probe.hysteresis_mm = noise.hysteresis;
}

LobingMap calibrated_on_sphere(const ProbeSignature& probe, double effective_radius,
                               const SphereCalibration& how) {
  const std::vector<Vec3> direction = directions();
  std::vector<double> radius;
  Vec3 before = Vec3::Zero();
  std::uint32_t reading = 0;
  for (const Vec3& n : direction) {
    double sum = 0.0;
    for (std::uint32_t k = 0; k < how.touches; ++k) {
      const double z = normal(how.seed, {static_cast<std::uint32_t>(RandomStream::probe), how.draw,
                                         kCommon, reading++});
      sum += probe.noise.of_touch(probe.to_probe * n, probe.to_probe * before, z);
      before = n;
    }
    radius.push_back(effective_radius + probe.bent_across() + sum / how.touches);
  }
  LobingFit fit;
  host::require(fit_lobing(direction, radius, fit), "calibration of the probe");
  for (const std::size_t shift : {1U, 2U, 3U})
    fit.map.coefficient[shift] = 0.0;
  return fit.map;
}

}  // namespace volcomp::sim
