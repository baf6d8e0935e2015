#include "host_sim/experiments/self_calibration/scenario.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"
#include "host_sim/experiments/self_calibration/bus_touches.hpp"
#include "host_sim/host/measure/identify/volume.hpp"
#include "host_sim/host/measure/volume_csv.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"
#include "host_sim/sim/truth/seeds.hpp"

namespace volcomp::self_calibration {
namespace {

using host::identify::LatchedTouch;
using host::identify::MeasurementPlan;

std::vector<LatchedTouch> touches_of(const MeasurementPlan& plan, const sim::PlanTruth& truth,
                                     const Options& options, const host::Progress& progress) {
  if (!options.make_axes) return sim::touch_all(plan, truth);
  return touch_on_bus(plan, truth, {options.make_axes, options.cycle_hz}, progress);
}

// Lengths of error vectors beside their best rigid motion, µm; `error(reading)` in the work frame,
// mm.
template <class Error>
std::vector<double> beside_rigid(const MachineChain& chain,
                                 const std::vector<any_machine::PlaceReading>& readings,
                                 const Error& error) {
  std::vector<Vec3> places;
  std::vector<Vec3> errors;
  for (const any_machine::PlaceReading& r : readings) {
    places.push_back(ideal_points(chain, r.pose, chain.tool_point()).work);
    errors.push_back(error(r));
  }
  std::vector<double> length;
  for (const Vec3& e : host::aligned_errors(places, errors))
    length.push_back(kUmPerMm * e.norm());
  return length;
}

VolumeResidual figures_of(std::vector<double> length) {
  if (length.empty()) return {};
  double squares = 0.0;
  for (const double l : length)
    squares += l * l;
  std::sort(length.begin(), length.end());
  const auto count = static_cast<double>(length.size());
  return {std::sqrt(squares / count), length[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1],
          length.back()};
}

// What reversal adds at a reading, of it what the correcting axes can reach; work frame.
Vec3 reversal_at(const sim::TrueMachine& truth, const any_machine::PlaceReading& r) {
  const Vec3 tool = truth.chain.tool_point();
  return any_machine::within_reach(truth.chain, r.pose,
                                   truth.error(r.pose, r.approach, tool).position_work -
                                       truth.error(r.pose, {}, tool).position_work);
}

std::vector<double> modelled_lengths(const Result& result, const any_machine::MachineState& state) {
  return beside_rigid(result.plan.machine.chain, state.place,
                      [&](const any_machine::PlaceReading& r) -> Vec3 {
                        if (result.models_reversal()) return r.deviation_mm;
                        return r.deviation_mm - reversal_at(result.truth, r);
                      });
}

// What the covariance says of the places of the verification.
void predict(Result& result) {
  namespace identify = host::identify;
  const identify::Problem problem = identify::Equations::made_consistent(result.plan.problem);
  const identify::Equations equations(problem, true);
  const identify::Triangle triangle = identify::triangle_at(equations, equations.start(), {});
  const Vec3 tool = problem.machine.chain.tool_point();
  identify::VolumePlaces places({});
  for (const any_machine::PlaceReading& r : result.after.place) {
    places.q.push_back(r.pose);
    if (result.models_reversal()) places.d.push_back(r.approach);
  }
  const identify::VolumeUncertainty u =
      identify::volume_uncertainty(equations, triangle, places, tool);
  const identify::DrawnVolume drawn = identify::draw_volume(equations, triangle, places, tool);
  result.predicted = {kUmPerMm * u.rms_rigid(), kUmPerMm * drawn.p95, kUmPerMm * drawn.max};
  for (const double one : u.rigid)
    result.u_um.push_back(kUmPerMm * one);
}

// The share of a step of the run.
host::Progress part_of(const host::Progress& progress, double from, double to) {
  return [&progress, from, to](double done, const std::string& what) {
    progress(from + (to - from) * done, what);
  };
}

}  // namespace

VolumeResidual Result::residual(const any_machine::MachineState& state) const {
  return figures_of(
      beside_rigid(plan.machine.chain, state.place,
                   [](const any_machine::PlaceReading& r) { return r.deviation_mm; }));
}

bool Result::models_reversal() const {
  const auto& functions = plan.problem.model.functions;
  return std::any_of(functions.begin(), functions.end(),
                     [](const auto& axis) { return !axis.reversal.empty(); });
}

VolumeResidual Result::without_unmodelled_reversal(const any_machine::MachineState& state) const {
  return figures_of(modelled_lengths(*this, state));
}

double Result::coverage() const {
  constexpr double kCoverageFactor = 2.0;
  const std::vector<double> length = modelled_lengths(*this, after);
  std::size_t within = 0;
  for (std::size_t i = 0; i < length.size(); ++i)
    if (length[i] <= kCoverageFactor * u_um[i]) ++within;
  return static_cast<double>(within) / static_cast<double>(length.size());
}

double Result::sphere_without_unmodelled_reversal_um(const any_machine::MachineState& state) const {
  if (models_reversal() || state.sphere.empty()) return state.sphere_um().max_um;
  const Vec3 first = reversal_at(truth, state.sphere.front());
  double worst = 0.0;
  for (const any_machine::PlaceReading& r : state.sphere)
    worst = std::max(worst, (r.deviation_mm - reversal_at(truth, r) + first).norm());
  return kUmPerMm * worst;
}

Result run_self_calibration(const Options& options, const host::Progress& progress) {
  Result result;
  result.options = options;
  progress(0.0, "reading the plan");
  const MeasurementPlan planned = host::identify::read_plan(options.plan, {{}, true});
  result.inputs = {host::hashed_file("measurement plan", options.plan),
                   host::hashed_file("machine file", planned.machine.path)};
  result.truth = sim::draw_machine(planned.machine, options.seed);
  sim::ShopFloor floor;
  floor.perfect = !options.noise;
  floor.seed = sim::seed_of(options.seed, sim::SeedOf::instruments);
  const sim::PlanTruth shop = sim::draw_plan_truth(planned.problem, result.truth, floor);

  const std::vector<LatchedTouch> touches =
      touches_of(planned, shop, options, part_of(progress, 0.0, 0.5));
  result.touches = touches.size();
  result.files = sim::files_of_plan(planned, shop, touches);
  result.plan = host::identify::read_plan(options.plan, {result.files, false});
  result.found = host::identify::identify(result.plan, {false, options.leave_out},
                                          part_of(progress, 0.5, 0.7));
  result.image = host::make_image(result.found.tables->tables);
  result.inputs.push_back(
      host::hashed_bytes("table image made for it", "tables.vct", result.image));

  const any_machine::Verification check = any_machine::plan_verification(
      planned.machine, options.places, sim::seed_of(options.seed, sim::SeedOf::places));
  result.sphere = check.sphere;
  progress(0.7, "the machine as it is");
  result.before = verify_machine(planned.machine, result.truth, check, options.make_cell, {});
  progress(0.85, "the machine compensated");
  result.after =
      verify_machine(planned.machine, result.truth, check, options.make_cell, result.image);
  predict(result);
  progress(1.0, "done");
  return result;
}

}  // namespace volcomp::self_calibration
