#pragma once
// Figures of a circular test, ISO 230-4:2005, clause 3 (quoted from memory, the print was not at
// hand). The centre is that of least squares, the usual practical form of the standard's least
// separation.

#include <array>

#include "comp/core/status.hpp"
#include "comp/metrology/circles/circle_test.hpp"

namespace volcomp {

// All in mm.
struct CircleFigures {
  std::array<double, 2> centre{};  // of the socket against the nominal centre
  double radius_deviation = 0.0;   // mean radius − nominal: a calibrated bar only
  double circular = 0.0;           // G; G(b) of both directions
  double radial_max = 0.0;         // F about the centre of the instrument, as set up
  double radial_min = 0.0;
  double centred_max = 0.0;  // F about the centre of least squares
  double centred_min = 0.0;
};

// Of the directions that were measured, about one common centre: give one direction for G, both for
// G(b) and D (radius_deviation). Arcs are evaluated as far as they go. Refused, in this order:
// length_mismatch, too_few_points (fewer than 3 readings), not_finite.
Status circle_figures(const CircleTest& test, CircleFigures& out);

}  // namespace volcomp
