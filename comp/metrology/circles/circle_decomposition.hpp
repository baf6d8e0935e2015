#pragma once
// What a circular test tells about two linear axes: least squares of harmonics, reversal and play
// over both directions.

#include <array>

#include "comp/core/status.hpp"
#include "comp/machine/machine_description.hpp"
#include "comp/metrology/circles/circle_test.hpp"

namespace volcomp {

struct CircleSettings {
  Axis first = Axis::x;  // the plane: angles rise from the first axis towards the second
  Axis second = Axis::y;
  double feed = 0.0;                          // of the path, mm/s, > 0; needed with both directions
  std::array<double, 2> cyclic_wavelength{};  // looked for in each axis, mm; 0: none
};

// Index 0: first axis, 1: second axis.
struct CircleParameters {
  double radius = 0.0;             // mean radius − nominal, mm
  std::array<double, 2> centre{};  // socket against nominal centre, mm
  // + : the first axis moves too far, mm/mm.
  double scale_mismatch = 0.0;
  // rad, as EC0Y, EA0Z or EB0Z of the tables has it, in whichever order the axes are named.
  double squareness = 0.0;
  // With both directions only. + : the first axis lags more, s.
  double servo_mismatch = 0.0;
  std::array<double, 2> reversal{};  // as ISO 230-2: mean of rising − mean of falling, mm
  std::array<double, 2> lateral{};   // reversal of the other component, mm
};

struct CircleDecomposition {
  CircleParameters value;
  CircleParameters u;              // standard uncertainties from the residuals alone
  std::array<double, 2> cyclic{};  // amplitudes, mm
  double rms = 0.0;                // of the residuals, with their degrees of freedom, mm
};

// What is left of every reading, mm, in the order of the traces; as long as these, or empty.
struct CircleResiduals {
  Span<double> ccw, cw;
};

// Refused, in this order: bad_setting (radius, first: the axis twice, feed, cyclic_wavelength),
// then what check_readings() refuses with fewer readings than twice the columns. Of one direction
// servo mismatch cannot be told from squareness: the caller says so.
Status decompose_circle(const CircleTest& test, const CircleSettings& settings,
                        const CircleResiduals& residuals, CircleDecomposition& out);

// A spike where an axis turns, after 0, 90, 180, 270 degrees of the path: what a residual is at
// most away from its surroundings within 10 degrees of travel, signed, mm. Missing with fewer than
// three readings there or on either side.
struct CircleSpike {
  double height = 0.0;
  bool known = false;
};
std::array<CircleSpike, 4> circle_spikes(Span<const double> theta, Span<const double> residual);

}  // namespace volcomp
