#pragma once
// Run-out of an external cylindrical gear: a ball in every space, touching both flanks (ISO
// 1328-2:1997, kept in ISO 1328-1:2013 as information; quoted from memory, the prints were not at
// hand).

#include <cstddef>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"

namespace volcomp {

struct BallInSpace {
  int teeth = 0;
  double module = 0.0;          // normal, mm
  double pressure_angle = 0.0;  // normal, rad
  double helix_angle = 0.0;     // rad
  double shift = 0.0;           // of the profile, modules
  double diameter = 0.0;        // of the ball, mm
};

// Where the ball sits in a space of the nominal gear.
struct BallSeat {
  double pressure_angle = 0.0;  // α_K of the transverse involute through its centre, rad
  double radius = 0.0;          // of its centre, mm
};

// Refused: bad_setting (field), out_of_reach 'diameter' for a ball that does not touch both flanks.
Status ball_seat(const BallInSpace& ball, BallSeat& out);

struct RunOut {
  double total = 0.0;         // F_r: range over the spaces
  double eccentricity = 0.0;  // amplitude of the first harmonic
};

// Refused: incomplete (count) unless both have as many as teeth, not_finite (field, index).
Status check_spaces(int teeth, Span<const double> left, Span<const double> right);

// `left`, `right`: deviations of the two flanks of every space in the transverse section along the
// line of action, + = excess material; of a normal deviation the cosine of the base helix angle has
// been taken out. `radial`, in their unit: how much further out the ball sits in each space.
// Refused: as check_spaces, then as ball_seat, length_mismatch.
Status run_out(const BallInSpace& ball, Span<const double> left, Span<const double> right,
               Span<double> radial, RunOut& out);

}  // namespace volcomp
