#pragma once
// Whether a point depends on the direction it was touched from: a probe that gives way more in some
// directions than in others, mapped on a sphere, then corrected on it.

#include "host_sim/experiments/l300g/grinder.hpp"
#include "host_sim/sim/truth/noise.hpp"

namespace volcomp::l300g {

struct LobingCheck {
  double raw_um = 0.0;        // largest deviation of a point with a constant radius
  double corrected_um = 0.0;  // with the map
};

// Spherical harmonics of first to third order, drawn at random, ±5 µm together; mapped from 36
// directions with 0.1 µm of noise, checked in 36 others. On a machine without errors: it is about
// the probe.
[[nodiscard]] LobingCheck check_lobing(const host::MachineFile& file,
                                       const sim::BusAxesFactory& make_axes, double cycle_hz,
                                       std::uint64_t seed);

}  // namespace volcomp::l300g
