#pragma once
// Classes of touch probes, by how far their touches scatter.

#include <array>
#include <cstddef>

namespace volcomp::sim {

// Repeatability in one direction, 2σ, µm, at a stylus of 50 mm (from memory): the LP2 as on its
// data sheet, the RMP600 (0.25 there) with the margin of a workshop.
struct ProbeClass {
  const char* name;
  double repeatability_2s_um;
};
inline constexpr std::array<ProbeClass, 3> kProbeClasses{
    {{"none", 0.0}, {"rmp600", 0.5}, {"lp2", 1.0}}};

}  // namespace volcomp::sim
