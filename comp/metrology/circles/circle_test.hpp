#pragma once
// Readings of a circular test, ISO 230-4: a ball bar, or any instrument that reads the distance
// between tool and a socket at the table while the machine goes round.

#include <cstddef>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"

namespace volcomp {

// One direction in the order of time. `theta`: nominal angle of the path, rad, from the first axis
// of the plane towards the second; rising counter-clockwise, falling clockwise. `radial`: length of
// the bar minus nominal radius, mm.
struct CircleTrace {
  Span<const double> theta;
  Span<const double> radial;
};

// Radii that ball bars have, mm.
inline constexpr double kLeastCircle = 20.0;
inline constexpr double kMostCircle = 1500.0;

struct CircleTest {
  double radius = 0.0;  // nominal, mm, > 0
  CircleTrace ccw, cw;  // of each as many angles as readings; none: that direction was not measured

  [[nodiscard]] bool both() const { return !ccw.theta.empty() && !cw.theta.empty(); }
};

// Calls visit(theta, radial, sense) for every reading; sense is 1 counter-clockwise, −1 clockwise.
template <class Visit>
void for_each_reading(const CircleTest& test, const Visit& visit) {
  for (std::size_t i = 0; i < test.ccw.theta.size(); ++i)
    visit(test.ccw.theta[i], test.ccw.radial[i], 1.0);
  for (std::size_t i = 0; i < test.cw.theta.size(); ++i)
    visit(test.cw.theta[i], test.cw.radial[i], -1.0);
}

// Refused, in this order, counter-clockwise first: length_mismatch (direction), not_finite
// (direction, field, index); too_few_points (count) where both have fewer than `least` together.
Status check_readings(const CircleTest& test, std::size_t least);

}  // namespace volcomp
