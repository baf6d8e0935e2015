#include "host_sim/experiments/l300g/scenario.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "host_sim/experiments/l300g/inspection_program.hpp"
#include "host_sim/experiments/l300g/traced_grinder.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/truth/seeds.hpp"

namespace volcomp::l300g {
namespace {

constexpr std::array<double, 5> kFeeds_mm_min{10.0, 30.0, 100.0, 300.0, 1000.0};
// At the fastest feed the axis has done with accelerating when it touches.
constexpr double kRunUp_mm = 0.5;

void from_mean(std::vector<double>& values) {
  double mean = 0.0;
  for (const double v : values)
    mean += v / static_cast<double>(values.size());
  for (double& v : values)
    v -= mean;
}

double spread(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

FeedCheck check_feeds(Grinder& grinder, GearInspector& inspector, const InvoluteGear& gear) {
  const Flank flank{FlankSide::left, 0};
  const MachineChain& chain = grinder.chain();
  FeedCheck check;
  for (const double feed : kFeeds_mm_min) {
    const sim::NodePoint point =
        inspector.touch({flank, pitch_roll(gear), 0.5 * gear.width}, {feed / 60.0, kRunUp_mm});
    const Vec3 latched = ideal_points(chain, point.latched, chain.tool_point()).work;
    check.feed_mm_min.push_back(feed);
    check.raw_nm.push_back(kNmPerMm * inspector.distance(flank, latched).distance);
    check.corrected_nm.push_back(kNmPerMm * inspector.distance(flank, point.workpiece).distance);
  }
  inspector.retract();
  from_mean(check.raw_nm);
  from_mean(check.corrected_nm);
  return check;
}

enum class When : std::uint8_t { before, after };

// What all measurements of a run share.
struct Inspection {
  const L300gOptions& options;
  const GrinderHall& hall;
  const host::BuiltTables& without;      // nothing compensated
  const host::BuiltTables& compensated;  // of the kind that is asked for
  const sim::Gear& gear;
  const InvoluteGear& involute;
  double rc;  // as calibrated before anything was compensated

  [[nodiscard]] const host::BuiltTables& built(When when) const {
    return when == When::before ? without : compensated;
  }
};

MachineTables tables_at(const host::BuiltTables& built, const MachineDescription& machine) {
  MachineTables tables = built.tables;
  tables.machine = machine;
  return tables;
}

// A probe that gives way by direction is calibrated on a sphere, too.
host::NodeProbe probe_of(const Inspection& run) {
  const ProbeScatter& scatter = run.hall.scatter;
  host::NodeProbe probe = host::node_probe(run.hall.file);
  const double stated = probe.radius.coefficient[0];
  probe.radius.coefficient[0] = run.rc;
  if (run.options.probe != 0 && run.options.map_radius)
    probe.radius = sim::calibrated_on_sphere(scatter.probe, stated, {scatter.seed, scatter.draw});
  return probe;
}

// The axis of A as found on the mandrel with these tables in force: it contains the part of the
// errors that is the same everywhere, which must not be subtracted twice.
MachineDescription zeroed_on_mandrel(const Inspection& run, When when) {
  const MachineChain& nominal = run.hall.file.chain;
  Grinder grinder(run.hall, run.built(when).tables);
  const Mounted as = when == When::before ? Mounted::mandrel_before : Mounted::mandrel_after;
  const Circle circle = calibrate_on_mandrel(grinder, {}, as).fit.geometric;
  return with_origin(nominal, circle.y, circle.z);
}

// As an NC program: with the tables in the program instead of in the node.
std::string program(const Inspection& run, When when, const InspectionSetup& setup,
                    const MachineChain& chain) {
  if (when == When::before) return inspection_program(setup, "before compensation", no_offset);
  VolumetricModel model = run.compensated.model;
  model.chain = chain;
  return inspection_program(setup, "the geometric error chain of X, Y, B and A compensated",
                            [&model](const Pose& pose) { return compensation_at(model, pose); });
}

// Where pitch is taken, at the left flank of tooth 0.
Vec3 orientation_at_pitch_point(const Inspection& run) {
  const MachineChain& chain = run.hall.file.chain;
  const InspectionSetup setup{grinder_geometry(chain), run.involute, run.options.path, run.rc};
  const FlankTouch touch{{FlankSide::left, 0}, pitch_roll(run.involute), 0.5 * run.involute.width};
  return run.hall.truth.error(flank_move(setup, touch, 0.0).contact, {}, chain.tool_point())
      .orientation_work;
}

GearInspection inspect(const Inspection& run, When when, FeedCheck* feeds) {
  const MachineDescription machine = run.options.origin == Origin::nominal
                                         ? run.hall.file.chain.description()
                                         : zeroed_on_mandrel(run, when);
  Grinder grinder(run.hall, tables_at(run.built(when), machine));
  grinder.mount(run.gear, when == When::before ? Mounted::gear_before : Mounted::gear_after);
  grinder.prober().configure(probe_of(run));
  const InspectionSetup setup{grinder.geometry(), run.involute, run.options.path, run.rc,
                              run.options.rules.traces};
  GearInspector inspector(grinder, setup, run.options.rules);
  GearInspection result = inspector.inspect();
  result.program = program(run, when, setup, grinder.chain());
  if (feeds != nullptr) *feeds = check_feeds(grinder, inspector, run.involute);
  return result;
}

ProbeScatter scatter_of(const L300gOptions& options, const Vec3& stylus) {
  ProbeScatter scatter;
  if (options.probe != 0)
    scatter.probe = {sim::touch_noise(sim::kProbeClasses.at(options.probe), options.seed), stylus};
  scatter.seed = options.seed;
  scatter.draw = options.draw;
  return scatter;
}

MandrelCalibration calibrate_first(const GrinderHall& hall, const host::BuiltTables& without) {
  Grinder grinder(hall, without.tables);
  return calibrate_on_mandrel(grinder, {});
}

std::shared_ptr<const host::BuiltTables> compensation_of(const L300gResult& result,
                                                         const sim::TrueMachine& truth) {
  const std::size_t knots = result.options.knots;
  if (result.options.tables == TableKind::identified) return result.identification.built;
  return host::constant_tables(result.machine,
                               result.options.tables == TableKind::means
                                   ? mean_errors(truth, result.machine)
                                   : zero_errors(),
                               knots);
}

}  // namespace

sim::TracerScatter tracer_of(const L300gOptions& options) {
  sim::TracerScatter scatter;
  scatter.perfect = !(options.tracer_um > 0.0);
  if (!scatter.perfect) scatter.reading_mm = options.tracer_um / kUmPerMm;
  scatter.seed = sim::seed_of(options.seed, sim::SeedOf::instruments);
  scatter.draw = options.draw;
  return scatter;
}

double FeedCheck::raw_spread_nm() const { return spread(raw_nm); }
double FeedCheck::corrected_spread_nm() const { return spread(corrected_nm); }

L300gResult run_l300g(const L300gOptions& options, const host::Progress& progress) {
  L300gResult result;
  result.options = options;
  result.machine = host::read_machine_file(options.machine);
  result.inputs = {host::hashed_file("machine file", options.machine)};
  if (!is_named(options.errors))
    result.inputs.push_back(host::hashed_file("errors of the machine", options.errors));
  result.gear = gear_to_measure(options.gear);
  if (!options.gear.empty()) result.inputs.push_back(host::hashed_file("gear", options.gear));
  if (result.machine.probe)
    require_ball_fits(result.gear, result.machine.probe->radius_mm,
                      options.gear.empty() ? "master gear" : options.gear.string());
  if (options.rules.traces.teeth > static_cast<std::size_t>(result.gear.teeth))
    throw host::UserError(fmt::format("--teeth: the gear has {}", result.gear.teeth));
  const GrinderHall hall{
      result.machine,
      make_l300g_truth(result.machine, grinder_errors(options.errors), options.seed),
      options.make_axes, options.cycle_hz,
      scatter_of(options,
                 result.machine.probe ? result.machine.probe->stylus : Vec3(Vec3::UnitZ()))};
  const sim::Gear gear(result.gear, [own = OwnDeviation(result.gear)](
                                        const Flank&, double s, double x) { return own(s, x); });

  progress(0.0, "identification of 24 error functions");
  result.identification = sim::trace_errors(hall.truth, result.machine, traced_plan(),
                                            tracer_of(options), options.knots);
  result.printed = printed_procedure(hall.truth, result.machine);
  progress(0.05, "probe calibration on the mandrel");
  const auto without = host::constant_tables(result.machine, zero_errors(), options.knots);
  const auto compensated = compensation_of(result, hall.truth);
  result.calibration = calibrate_first(hall, *without);
  const SwingArm arm = grinder_geometry(result.machine.chain).arm;
  result.longer_arm = effect_of_arm(arm, kLongerArm_mm);
  for (const double higher : kHigherPivots_mm)
    result.higher_pivot.push_back(effect_of_pivot(arm, higher));

  const Inspection run{
      options, hall, *without, *compensated, gear, result.gear, result.calibration.rc};
  result.truth = true_gear(result.gear);
  result.orientation = orientation_at_pitch_point(run);
  progress(0.2, "gear, uncompensated");
  result.before = inspect(run, When::before, nullptr);
  progress(0.6, "gear, compensated");
  result.after = inspect(run, When::after, &result.feeds);
  if (options.scatters())
    result.on_centre = gear_on_centre(result.gear, {}, options.seed, options.draw);
  progress(0.95, "lobing of the probe");
  result.lobing = check_lobing(result.machine, options.make_axes, options.cycle_hz, options.seed);
  progress(1.0, "done");
  return result;
}

}  // namespace volcomp::l300g
