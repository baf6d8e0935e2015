#pragma once
// Spheres of a placement as a plan touches them before anything is measured: where the axes stand,
// and the five touches of each.

#include <array>
#include <vector>

#include "host_sim/host/measure/identify/plan_file.hpp"

namespace volcomp::host::identify {

// Which tips touch, and where the rotary axes stand.
struct SphereChoice {
  std::vector<std::size_t> tips;
  std::vector<std::size_t> more_tips;              // at every `more_every`-th position as well
  std::size_t more_every = 1;                      // from 1
  std::array<std::vector<double>, kMaxAxes> turn;  // rad; none: the reference alone
};

// Every sphere with every tip at every combination of rotary positions, as centres, or as five
// touches each; what is out of reach is named in the plan. `sigma`: of one touch, mm. Throws
// UserError where the set-up has no pose.
void add_planned_spheres(MeasurementPlan& plan, const SphereChoice& choice, double sigma,
                         SetUp& setup);

// Ways out of a sphere along which it is touched, work frame: the pole, away from what it stands
// on, and four round the equator; each at a right angle to the one before.
inline constexpr std::size_t kTouchesOfSphere = 5;
[[nodiscard]] std::array<Vec3, kTouchesOfSphere> touch_directions(const Placement& pose);

// From how far a touch begins, and how far it goes on where there is nothing: mm from the contact.
inline constexpr double kClearance_mm = 3.0;
inline constexpr double kOvertravel_mm = 2.0;

// A touch as a controller moves: from a place clear of the sphere straight towards its centre.
struct TouchMove {
  std::size_t setup = 0;
  std::size_t sphere = 0;
  std::size_t stylus = 0;
  Pose from{};
  Pose beyond{};
};
// The touches of all spheres of a set-up that has a pose, in the order of its observations.
[[nodiscard]] std::vector<TouchMove> touch_moves(const MeasurementPlan& plan, std::size_t setup);

// Sides from which the axes have arrived after one more straight move.
void arrive_at(const Pose& from, const Pose& to, Directions& d);

}  // namespace volcomp::host::identify
