#include "host_sim/experiments/any_machine/scenario.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/sim/campaign/any_axes.hpp"
#include "host_sim/sim/campaign/located_runs.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"
#include "host_sim/sim/truth/seeds.hpp"

namespace volcomp::any_machine {
namespace {

// Slopes are kept: the place of rotary axes counts from the actual axes, and the closure subtracts
// from the squareness what the straightness already holds.
std::unique_ptr<host::BuiltTables> build(const sim::Campaign& campaign,
                                         const MachineOptions& options) {
  host::BuildOptions how = host::tables_only(host::ModelKind::abbe_closed, options.knots);
  how.slope = SlopeFit::keep;
  return host::build_tables(campaign.machine, campaign.runs, how);
}

// After the axes and their squareness the places of the rotary axes: what is already known of the
// machine is taken off what the instrument reads.
std::unique_ptr<host::BuiltTables> measure(const sim::TrueMachine& truth,
                                           const sim::CampaignDraw& draw, MachineResult& result) {
  const MachineOptions& options = result.options;
  const sim::NoiseClasses classes =
      options.noise ? sim::workshop_noise(result.machine) : sim::no_noise();
  sim::Campaign campaign = sim::measure_any_machine(truth, result.machine, classes,
                                                    options.noise ? options.runs : 1, draw);
  sim::forget_places(campaign);
  result.locations =
      sim::locate_rotary_axes(truth, campaign.machine, build(campaign, options)->model,
                              {!options.noise, sim::seed_of(options.seed, sim::SeedOf::locations)});
  sim::put_in_place(result.locations.place, campaign);
  return build(campaign, options);
}

}  // namespace

double MachineResult::effect_um(const MachineState& state) const {
  return kUmPerMm * options.tool_length_mm * state.tilt_max_rad();
}

double MachineResult::steerable_um(const MachineState& state) const {
  return kUmPerMm * options.tool_length_mm * state.steerable_max_rad();
}

MachineResult run_machine_with(const host::MachineFile& file, const sim::TrueMachine& truth,
                               const MachineOptions& options, const host::Progress& progress) {
  MachineResult result;
  result.options = options;
  result.machine = file;
  result.authority = host::least_authority(file);
  progress(0.0, "choosing a place for the ball");
  const Verification verification =
      plan_verification(file, options.places, sim::seed_of(options.seed, sim::SeedOf::places));
  result.sphere = verification.sphere;

  // A constant of what an axis carries is no error of the machine: it is where the work lies.
  const sim::TrueMachine machine = sim::counted_from_references(truth, file);
  const sim::CampaignDraw draw{sim::seed_of(options.seed, sim::SeedOf::instruments), 0};
  const auto tables = measure(machine, draw, result);
  result.warnings = tables->warnings;
  const std::vector<std::uint8_t> image = host::make_image(tables->tables);
  result.inputs = {host::hashed_bytes("table image made for it", "tables.vct", image)};

  sim::TrueMachine at_check = machine;
  if (options.noise)
    at_check.temperature_offset_K = sim::check_temperature(sim::NoiseClasses{}, draw);
  progress(0.1, "the machine as it is");
  result.before = verify_machine(file, at_check, verification, options.make_cell, {});
  progress(0.55, "the machine compensated");
  result.after = verify_machine(file, at_check, verification, options.make_cell, image);
  progress(1.0, "done");
  return result;
}

MachineResult run_machine(const MachineOptions& options, const host::Progress& progress) {
  const host::MachineFile file = host::read_machine_file(options.machine);
  MachineResult result =
      run_machine_with(file, sim::draw_machine(file, options.seed), options, progress);
  result.inputs.insert(result.inputs.begin(), host::hashed_file("machine file", options.machine));
  return result;
}

}  // namespace volcomp::any_machine
