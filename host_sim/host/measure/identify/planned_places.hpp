#pragma once
// Places where instruments are read when a plan says no other: a tracer all over the travels, a
// ball bar round its circle, diagonals and steps from corner to corner, an R-test at positions of
// the rotary axes, runs at the targets of an axis.

#include <array>
#include <optional>
#include <vector>

#include "host_sim/host/measure/identify/plan_file.hpp"

namespace volcomp::host::identify {

struct PlaceChoice {
  std::size_t count = 0;          // of a tracer
  std::vector<std::size_t> tips;  // one after the other; none: the reference stylus
  std::array<std::vector<double>, kMaxAxes> turn;  // R-test, rad
  std::optional<Vec3> ball;                        // R-test: centre of the ball, work frame
};
inline constexpr std::size_t kTracerPlaces = 170;

// Fills places, tips and directions of the set-up; readings stay empty. Throws UserError where an
// R-test has no ball, or nothing is within reach.
void add_planned_places(const MeasurementPlan& plan, const PlaceChoice& choice, SetUp& setup);

}  // namespace volcomp::host::identify
