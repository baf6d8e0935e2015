#include "host_sim/experiments/any_machine/scenario.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/sim/campaign/any_axes.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"
#include "host_sim/sim/truth/seeds.hpp"

namespace volcomp::any_machine {
namespace {

struct Verification {
  const host::MachineFile& file;
  const sim::TrueMachine& truth;
  const MachineOptions& options;
  std::vector<sim::MeasuredLine> lines;
  std::vector<Pose> poses;
  SpherePlan sphere;
};

host::VolumeFigures figures_of(const MachineChain& chain,
                               const std::vector<PlaceReading>& readings) {
  std::vector<host::VolumePoint> points;
  points.reserve(readings.size());
  for (const PlaceReading& r : readings)
    points.push_back({ideal_points(chain, r.pose, chain.tool_point()).work, r.deviation_mm});
  return points.empty() ? host::VolumeFigures{} : host::aligned_volume_figures(std::move(points));
}

MachineState verify(const Verification& v, const std::vector<std::uint8_t>& image) {
  const auto cell = v.options.make_cell(v.truth, v.file.correction, image);
  Pose start{};
  for (std::size_t a = 0; a < v.file.axes.size(); ++a)
    start[a] = v.file.axes[a].reference;
  cell->place(start);
  MachineState state;
  for (const sim::MeasuredLine& line : v.lines)
    state.line.push_back(measure_line(*cell, v.file.chain, line));
  state.sphere = measure_sphere(*cell, v.file.chain, v.sphere);
  state.place = measure_places(*cell, v.file.chain, v.poses);
  state.volume = figures_of(v.file.chain, state.place);
  return state;
}

// Slopes are kept: the place of rotary axes counts from the actual axes, and the closure subtracts
// from the squareness what the straightness already holds.
std::unique_ptr<host::BuiltTables> build(const sim::Campaign& campaign,
                                         const MachineOptions& options) {
  host::BuildOptions how = host::tables_only(host::ModelKind::abbe_closed, options.knots);
  how.slope = SlopeFit::keep;
  return host::build_tables(campaign.machine, campaign.runs, how);
}

template <class Visit>
void for_each_reading(const MachineState& state, const Visit& visit) {
  for (const auto* readings : {&state.place, &state.sphere}) {
    for (const PlaceReading& r : *readings)
      visit(r);
  }
}

}  // namespace

double MachineState::lines_max_um() const {
  double worst = 0.0;
  for (const sim::MeasuredDiagonal& d : line)
    worst = std::max(worst, d.max_abs_um);
  return worst;
}

host::VolumeFigures MachineState::sphere_um() const {
  host::VolumeFigures f;
  double squares = 0.0;
  for (const PlaceReading& r : sphere) {
    const double um = kUmPerMm * r.deviation_mm.norm();
    f.max_um = std::max(f.max_um, um);
    squares += um * um;
  }
  if (!sphere.empty()) f.rms_um = std::sqrt(squares / static_cast<double>(sphere.size()));
  return f;
}

double MachineState::tilt_max_rad() const {
  double worst = 0.0;
  for_each_reading(*this, [&](const PlaceReading& r) { worst = std::max(worst, r.tilt_rad); });
  return worst;
}

double MachineState::tilt_rms_rad() const {
  double squares = 0.0;
  for_each_reading(*this, [&](const PlaceReading& r) { squares += r.tilt_rad * r.tilt_rad; });
  const std::size_t count = place.size() + sphere.size();
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

double MachineState::steerable_max_rad() const {
  double worst = 0.0;
  for_each_reading(*this, [&](const PlaceReading& r) { worst = std::max(worst, r.steerable_rad); });
  return worst;
}

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
  result.sphere = plan_sphere_test(file);

  const sim::NoiseClasses classes = options.noise ? sim::NoiseClasses{} : sim::no_noise();
  sim::Random random(sim::seed_of(options.seed, sim::SeedOf::instruments));
  const sim::Campaign campaign =
      sim::measure_any_machine(truth, file, classes, options.noise ? options.runs : 1, random);
  const auto tables = build(campaign, options);
  result.warnings = tables->warnings;
  const std::vector<std::uint8_t> image = host::make_image(tables->tables);
  result.inputs = {host::hashed_bytes("table image made for it", "tables.vct", image)};

  sim::TrueMachine at_check = truth;
  at_check.temperature_offset_K = random.normal(classes.temperature_K);
  const Verification verification{
      file,
      at_check,
      options,
      diagonals_of(file),
      random_poses(file, options.places, sim::seed_of(options.seed, sim::SeedOf::places)),
      result.sphere};
  progress(0.1, "the machine as it is");
  result.before = verify(verification, {});
  progress(0.55, "the machine compensated");
  result.after = verify(verification, image);
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
