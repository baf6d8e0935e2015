#include "host_sim/experiments/self_calibration/scenario.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"
#include "host_sim/experiments/self_calibration/bus_touches.hpp"
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

// Lengths of error vectors, µm; `error(reading)` in the work frame, mm.
template <class Error>
Left beside_rigid(const MachineChain& chain, const std::vector<any_machine::PlaceReading>& readings,
                  const Error& error) {
  std::vector<Vec3> places;
  std::vector<Vec3> errors;
  for (const any_machine::PlaceReading& r : readings) {
    places.push_back(ideal_points(chain, r.pose, chain.tool_point()).work);
    errors.push_back(error(r));
  }
  std::vector<double> length;
  double squares = 0.0;
  for (const Vec3& e : host::aligned_errors(places, errors)) {
    length.push_back(kUmPerMm * e.norm());
    squares += length.back() * length.back();
  }
  if (length.empty()) return {};
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

// The share of a step of the run.
host::Progress part_of(const host::Progress& progress, double from, double to) {
  return [&progress, from, to](double done, const std::string& what) {
    progress(from + (to - from) * done, what);
  };
}

}  // namespace

Left Result::left(const any_machine::MachineState& state) const {
  return beside_rigid(plan.machine.chain, state.place,
                      [](const any_machine::PlaceReading& r) { return r.deviation_mm; });
}

bool Result::knows_reversal() const {
  const auto& functions = plan.problem.model.functions;
  return std::any_of(functions.begin(), functions.end(),
                     [](const auto& axis) { return !axis.reversal.empty(); });
}

Left Result::left_of_known(const any_machine::MachineState& state) const {
  if (knows_reversal()) return left(state);
  return beside_rigid(plan.machine.chain, state.place, [&](const any_machine::PlaceReading& r) {
    return Vec3(r.deviation_mm - reversal_at(truth, r));
  });
}

double Result::sphere_of_known_um(const any_machine::MachineState& state) const {
  if (knows_reversal() || state.sphere.empty()) return state.sphere_um().max_um;
  const Vec3 first = reversal_at(truth, state.sphere.front());
  double worst = 0.0;
  for (const any_machine::PlaceReading& r : state.sphere)
    worst = std::max(worst, (r.deviation_mm - reversal_at(truth, r) + first).norm());
  return kUmPerMm * worst;
}

Left Result::predicted() const {
  return {kUmPerMm * found.volume.rms, kUmPerMm * found.volume.p95, kUmPerMm * found.volume.max};
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
  progress(1.0, "done");
  return result;
}

}  // namespace volcomp::self_calibration
