#pragma once
// A plan carried out on a simulated machine: what its instruments read and where its touches latch.
// The same tables that a shop would write.

#include <map>
#include <string>
#include <vector>

#include "host_sim/host/measure/identify/observation_text.hpp"
#include "host_sim/host/measure/identify/planned_spheres.hpp"
#include "host_sim/host/tables/runs_csv.hpp"
#include "host_sim/sim/campaign/plan_truth.hpp"

namespace volcomp::sim {

// Where the functional point of a stylus really is: work frame, for these encoders.
[[nodiscard]] Vec3 true_point(const TrueMachine& machine, const Pose& q,
                              const host::identify::Directions& d, const Vec3& tip);

// Scatter of a touch, probe and machine together: distance outside the nominal contact, mm; another
// number for each touch.
[[nodiscard]] double scatter_of_touch(const host::identify::MeasurementPlan& plan,
                                      const PlanTruth& truth, std::size_t setup,
                                      std::uint32_t touch);

// Where a move towards a sphere ends: encoders at the contact. `d`: sides from which the axes have
// arrived, brought forward by the move. Throws UserError where nothing is touched.
[[nodiscard]] host::identify::LatchedTouch touch_sphere(const host::identify::MeasurementPlan& plan,
                                                        const PlanTruth& truth,
                                                        const host::identify::TouchMove& move,
                                                        double scatter_mm,
                                                        host::identify::Directions& d);
// All touches of all set-ups that have a pose.
[[nodiscard]] std::vector<host::identify::LatchedTouch> touch_all(
    const host::identify::MeasurementPlan& plan, const PlanTruth& truth);

// Readings of a set-up of any other kind, in its `y`; those of runs as in a table of runs.
void read_instrument(const host::identify::MeasurementPlan& plan, const PlanTruth& truth,
                     std::size_t setup, host::identify::SetUp& out);
[[nodiscard]] host::RunsFile read_axis(const host::identify::MeasurementPlan& plan,
                                       const PlanTruth& truth, std::size_t setup);

// The files of the plan, by name. Throws UserError where a set-up names none, or where set-ups of
// other kinds share one.
[[nodiscard]] std::map<std::string, std::string> simulate_plan(
    const host::identify::MeasurementPlan& plan, const PlanTruth& truth);
// The same with touches from elsewhere.
[[nodiscard]] std::map<std::string, std::string> files_of_plan(
    const host::identify::MeasurementPlan& plan, const PlanTruth& truth,
    const std::vector<host::identify::LatchedTouch>& touches);

}  // namespace volcomp::sim
