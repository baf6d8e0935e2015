#pragma once
// Error functions drawn at random, of the size they have on a good machine that was never
// compensated. Lengths in mm, angles in rad.

#include "host_sim/sim/truth/noise.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Amplitude of one of the six error motions of a linear axis; `own` is the channel of positioning.
[[nodiscard]] double default_amplitude(std::size_t channel, std::size_t own);

// Waves at random phases on a straight line that rises by `rise` over the travel.
[[nodiscard]] ErrorFunction waves_on_line(double rise, double amplitude, Random& random);

// Ripple of the screw, in positioning.
void draw_ripple(ErrorFunction& positioning, Random& random);

// Reversal of positioning, and of the angles that are not positioning.
void draw_reversal(std::size_t own, TrueAxis& axis, Random& random);

}  // namespace volcomp::sim
