#pragma once
// What a touch probe does by direction: lobing, bending of the stylus and hysteresis, on a machine
// whose tool frame need not have the stylus along Z; and what a calibration makes of it.

#include <cstdint>

#include "comp/probe/lobing.hpp"
#include "host_sim/sim/instruments/touch_noise.hpp"
#include "host_sim/sim/instruments/touch_probe.hpp"

namespace volcomp::sim {

struct ProbeSignature {
  TouchNoise noise;                  // in a frame with the stylus along z
  Mat3 to_probe = Mat3::Identity();  // from the tool frame into that one

  ProbeSignature() = default;
  // `stylus`: its axis in the tool frame, unit, not −Z.
  ProbeSignature(const TouchNoise& touches, const Vec3& stylus);

  // What this direction adds to the radius, by its normal in the tool frame, mm.
  [[nodiscard]] double by_direction(const Vec3& normal) const;
  // How much more the ball has than its effective radius across the stylus, which is what machine
  // files state: by so much the stylus bends until the probe triggers, mm.
  [[nodiscard]] double bent_across() const { return -noise.bending(Vec3::UnitX()); }

  // Into the settings of a probe whose radius is the effective one.
  void give_to(TouchProbe::Settings& probe) const;
};

// Which random numbers a calibration takes, and how often it touches each place.
struct SphereCalibration {
  std::uint64_t seed = 1;
  std::uint32_t draw = 0;
  std::uint32_t touches = 5;
};

// The map that 36 directions on a sphere give, scatter and hysteresis included. The place of the
// sphere is not known, so the three terms that cannot be told from it stay 0.
[[nodiscard]] LobingMap calibrated_on_sphere(const ProbeSignature& probe, double effective_radius,
                                             const SphereCalibration& how);

}  // namespace volcomp::sim
