#pragma once
// A ball plate in the XYFZ machine: a plan whose readings follow from errors that are known.

#include <cmath>
#include <random>
#include <vector>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/equations.hpp"
#include "host_sim/host/measure/identify/touched_spheres.hpp"

namespace volcomp::test {

using namespace host::identify;

inline Machine machine_of(const host::MachineFile& file) {
  Machine machine;
  machine.chain = file.chain;
  for (std::size_t a = 0; a < file.axes.size(); ++a)
    machine.travel.at(a) = {file.axes[a].lo, file.axes[a].hi, file.axes[a].reference,
                            file.axes[a].full_turn()};
  return machine;
}

// Two segments an axis, the Y datum, three tips, nine balls; no set-up.
inline MeasurementPlan empty_plan() {
  MeasurementPlan plan;
  plan.path = "plate";
  plan.machine = host::read_machine_file(host::bundled_machine("xyfz"));
  plan.problem.machine = machine_of(plan.machine);
  for (std::size_t a = 0; a < 3; ++a)
    plan.problem.model.functions.at(a) = {2, {0, 1, 2, 3, 4, 5}, {}};
  const std::size_t X = plan.machine.axis_index('X');
  const std::size_t Y = plan.machine.axis_index('Y');
  plan.problem.model.gauge = {{Y, 0}, {Y, 2}, {X, 2}};
  const Vec3 tip = plan.machine.chain.tool_point();
  plan.problem.styli = {{"S0", tip, 3.0, {}, {}},
                        {"S1", tip + Vec3(60.0, 0.0, 30.0), 3.0, 0.1, {}},
                        {"S2", tip + Vec3(0.0, 60.0, 30.0), 3.0, 0.1, {}},
                        {"S3", tip + Vec3(0.0, 0.0, -80.0), 3.0, 0.1, {}}};
  Artefact plate;
  plate.name = "plate";
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      plate.spheres.emplace_back(120.0 * i, 120.0 * j, 0.0);
  plate.radius.assign(plate.spheres.size(), 10.0);
  plan.problem.artefacts = {plate};
  return plan;
}

// Errors of some 10 µm and 20 µrad, in the basis of the plan.
inline VectorXd some_errors(const Unknowns& unknowns, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  VectorXd x = VectorXd::Zero(unknowns.size());
  for (Index i = 0; i < unknowns.of_machine(); ++i)
    x(i) = any(random) * (unknowns.is_angle(i) ? 20e-6 : 10e-3);
  return x;
}

// Where the machine with these errors stands when the tip is at a place of the work frame; false
// out of its travel.
inline bool stand_at(const Problem& problem, const Unknowns& unknowns, const VectorXd& x,
                     const Vec3& tip, const Vec3& place, Pose& q) {
  const MachineChain& chain = problem.machine.chain;
  for (int step = 0; step < 8; ++step) {
    const ErrorSet errors = unknowns.errors(q, {}, x);
    const Vec3 way = place - actual_tips(chain, q, errors).in_work(tip);
    move_by(chain, ideal_geometry(chain, q), way, q);
  }
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    const host::identify::Travel& travel = problem.machine.travel.at(a);
    if (q.at(a) < travel.lo || q.at(a) > travel.hi) return false;
  }
  return true;
}

// Touches of all balls of a placement with all tips: the pole and four round the equator.
inline std::vector<TipTouch> touches_of(const Problem& problem, const Unknowns& unknowns,
                                        const VectorXd& x, const Placement& pose) {
  const std::vector<Vec3> normals{Vec3::UnitZ(), Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(),
                                  -Vec3::UnitY()};
  const Artefact& plate = problem.artefacts[0];
  std::vector<TipTouch> touches;
  for (std::size_t tip = 0; tip < problem.styli.size(); ++tip) {
    for (std::size_t sphere = 0; sphere < plate.spheres.size(); ++sphere) {
      const Vec3 centre = pose.R * plate.spheres[sphere] + pose.t;
      std::vector<TipTouch> group;
      for (const Vec3& n : normals) {
        TipTouch touch;
        touch.sphere = sphere;
        touch.stylus = tip;
        const double apart = plate.radius[sphere] + problem.styli[tip].radius;
        if (stand_at(problem, unknowns, x, problem.styli[tip].offset, centre + apart * n, touch.q))
          group.push_back(touch);
      }
      if (group.size() == normals.size()) touches.insert(touches.end(), group.begin(), group.end());
    }
  }
  return touches;
}

inline std::vector<Placement> placements() {
  const auto at = [](const Vec3& turn, const Vec3& t) {
    return Placement{exponential(volcomp::kPi / 180.0 * turn), t};
  };
  return {at({0, 0, 0}, {-225, 20, 275}),   at({0, 0, 0}, {-15, 20, 275}),
          at({0, 0, 0}, {-225, 20, 630}),   at({0, 0, 0}, {-15, 20, 630}),
          at({90, 0, 0}, {-225, 270, 275}), at({90, 0, 0}, {-15, 10, 385}),
          at({0, -90, 0}, {-220, 15, 275}), at({0, -90, 0}, {0, 15, 385})};
}

// The plan with what a machine with these errors has touched, without noise.
inline MeasurementPlan touched_plan(unsigned seed, VectorXd& truth) {
  MeasurementPlan plan = empty_plan();
  const Unknowns unknowns(plan.problem, true);
  truth = some_errors(unknowns, seed);
  const Problem touched = plan.problem;
  for (const Placement& pose : placements()) {
    SetUp setup;
    setup.name = "placement " + std::to_string(plan.problem.setups.size() + 1);
    setup.kind = ObservationKind::centre;
    setup.artefact = 0;
    setup.pose = pose;
    plan.touched.emplace_back();
    add_centres(plan, "touches.csv", touches_of(touched, unknowns, truth, pose), 0.8e-3, setup);
    plan.problem.setups.push_back(setup);
  }
  return plan;
}

}  // namespace volcomp::test
