#pragma once
// What is true while a plan is carried out and not known: where artefacts and instruments really
// stand, how long styli really are, how warm the axes are at each set-up. What a plan leaves free
// without a known length is as the plan has it.

#include <cstdint>
#include <vector>

#include "host_sim/host/measure/identify/problem.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Standard deviations of what a plan says nothing of, and whether anything scatters at all.
struct ShopFloor {
  bool perfect = false;         // instruments; things still stand elsewhere than the plan says
  double growth_K = 0.1;        // of each linear axis between set-ups
  double stylus_mm = 0.02;      // of each coordinate of a tip, after a tool setter
  double pose_mm = 0.3;         // of a placement against the plan
  double pose_rad = 1e-3;       // likewise
  double station_mm = 1.0;      // of a tracer whose place is not known, a socket or a ball
  double dead_length_mm = 5.0;  // of whatever counts from an unknown zero
  double mirror_rad = 1e-4;     // tilt of a mirror
  double drift_mm = 0.2e-3;     // of a tracer in an hour, as a walk
  double dwell_s = 5.0;         // from one of its readings to the next

  std::uint64_t seed = 1;
  std::uint32_t draw = 0;  // one of several with that seed
};

// Root mean square of what a tracer drifts by during so many places of a station, about the mean,
// which its unknown length takes; mm.
[[nodiscard]] double tracer_drift_mm(const ShopFloor& floor, std::size_t places);

struct TrueSetUp {
  TrueMachine machine;             // as warm as it is then
  host::identify::Placement pose;  // of the artefact
  double kappa = 0.0;              // lengths are longer by this share than the instrument says
  Vec3 station = Vec3::Zero();     // tracer, socket, ball of an R-test; work frame
  double dead_length = 0.0;        // mm
  Vec3 mirror = Vec3::UnitZ();     // normal, tool frame
  ErrorMotion zero = ErrorMotion::Zero();  // of a run: what its instrument was set to
};

struct PlanTruth {
  ShopFloor floor;
  std::vector<Vec3> tip;  // tool frame
  std::vector<double> tip_radius;
  std::vector<std::vector<Vec3>> sphere;  // by artefact, in its frame
  std::vector<TrueSetUp> setup;
};

// The same for the same seed.
[[nodiscard]] PlanTruth draw_plan_truth(const host::identify::Problem& problem,
                                        const TrueMachine& machine, const ShopFloor& floor);

}  // namespace volcomp::sim
