#pragma once
// A circular test as it was measured, ISO 230-4: circles of one or both directions, gone round once
// or several times.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "comp/core/status.hpp"
#include "comp/machine/error_motion.hpp"
#include "comp/metrology/circles/circle_decomposition.hpp"

namespace volcomp::host {

// Readings of one circle in the order of time (circle_test.hpp): rad, mm.
struct BallBarCircle {
  std::vector<double> theta;
  std::vector<double> radial;
  long run = 1;
  std::vector<std::size_t> line;  // of every reading in the file; empty: from none

  [[nodiscard]] CircleTrace trace() const { return {theta, radial}; }
  // Last reading and the step after it reach the first one again.
  [[nodiscard]] bool full() const;
};

inline constexpr std::array<const char*, 2> kCircleDirections{"ccw", "cw"};

struct BallBarTest {
  std::string name;                   // of the file
  std::optional<std::string> plane;   // "XY": angles rise from X towards Y
  std::optional<double> radius;       // nominal, mm, 20…1500
  std::optional<double> feed;         // of the path, mm/min; needed with both directions
  std::optional<Vec3> centre;         // of the circle, NC coordinates, mm
  std::optional<double> temperature;  // °C
  bool calibrated = false;            // the length of the bar is known
  std::array<double, 2> cyclic{};     // wavelengths looked for in each axis, mm; 0: none
  std::array<std::vector<BallBarCircle>, 2> circle;  // ccw, cw
  std::size_t overshoot = 0;                         // readings beyond a full turn, left out

  [[nodiscard]] bool both() const { return !circle[0].empty() && !circle[1].empty(); }
};

// Whether it can be evaluated. Refused, in this order: missing_field (plane, radius_mm, theta,
// radial), unknown_plane, bad_setting radius_mm, missing_field feed_mm_min (with both directions),
// bad_setting feed_mm_min (0.1…1e6) and cyclic_mm (0, or 0.01 mm to the radius: what is longer
// looks like an offset); then by direction and circle (direction, run; index): length_mismatch,
// not_finite, unit_suspected (more than 2 mm: whole lengths?), positions_not_monotone (runs the
// other way), too_few_points (count; fewer than 36), gap (more than 10 degrees), arc_too_short
// (less than 180 degrees), off_centre (socket more than 1 mm away).
[[nodiscard]] Status check(const BallBarTest& test);

// Of a test that can be evaluated.
[[nodiscard]] CircleSettings circle_settings(const BallBarTest& test);

// The squareness it tells, by the name it has in tables: "EC0Y", "EA0Z" or "EB0Z", whatever the
// order of the axes.
[[nodiscard]] const char* squareness_name(const CircleSettings& settings);

}  // namespace volcomp::host
