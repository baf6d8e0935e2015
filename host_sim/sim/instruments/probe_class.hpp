#pragma once
// Classes of touch probes: how far their touches scatter, and what depends on the direction.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "host_sim/host/machine/probe_class_names.hpp"
#include "host_sim/sim/instruments/touch_noise.hpp"

namespace volcomp::sim {

// At a stylus of 50 mm. Repeatability is unidirectional, 2σ; the LP2 has that of its data sheet,
// the RMP600 (0.25 µm there) the margin of a workshop. Repeatability, lobing and forces are from
// memory, hysteresis and stiffness chosen.
struct ProbeClass {
  const char* name;
  double repeatability_2s_um;
  double lobing_um;      // amplitude of three lobes round the stylus
  double hysteresis_um;  // between touches from opposite sides
  double force_across_N, force_along_N;
  double stiffness_across_N_mm, stiffness_along_N_mm;
};
inline constexpr std::array<ProbeClass, host::kProbeClassNames.size()> kProbeClasses{
    {{host::kProbeClassNames[0], 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0},
     {host::kProbeClassNames[1], 0.5, 0.25, 0.1, 0.08, 1.9, 60.0, 5000.0},
     {host::kProbeClassNames[2], 1.0, 2.0, 0.5, 0.65, 5.85, 60.0, 5000.0}}};

// "2σ = 1 µm in one direction, lobes of 2 µm, hysteresis of 0.5 µm, a bending stylus".
[[nodiscard]] std::string probe_text(const ProbeClass& probe);

// Of a probe of this class; `seed` turns its lobes.
[[nodiscard]] TouchNoise touch_noise(const ProbeClass& probe, std::uint64_t seed);

}  // namespace volcomp::sim
