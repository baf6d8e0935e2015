#include "host_sim/experiments/xyfz/scenario.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "comp/metrology/tables/per_axis.hpp"
#include "host_sim/experiments/xyfz/dynamics.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/campaign/measured_positions.hpp"

namespace volcomp::sim {
namespace {

constexpr std::array<ModelKind, 3> kModels{ModelKind::naive, ModelKind::abbe,
                                           ModelKind::abbe_closed};
constexpr std::size_t kPerAxisKnots = 32;

// Everything a scenario run needs at hand.
struct Bench {
  const XyfzOptions& options;
  MachineFile machine;
  TrueMachine truth;
  DiagonalBox box;
  std::filesystem::path folder;
};

// The road of a user's own data: the runs go through files.
Campaign through_files(const Campaign& campaign, const std::filesystem::path& folder) {
  create_folder(folder);
  Campaign reread{campaign.machine, {}};
  for (const RunsFile& runs : campaign.runs) {
    const std::filesystem::path path = folder / runs.name;
    write_runs_file(path, runs);
    reread.runs.push_back(read_runs_file(path));
  }
  return reread;
}

ModeResult verify_mode(const Bench& bench, const std::vector<std::uint8_t>& image) {
  Random unused(0);
  const auto cell = bench.options.make_cell(bench.truth, bench.machine.correction, image);
  cell->place(bench.box.lo);
  ModeResult result;
  for (const Diagonal& d : body_diagonals(bench.box)) {
    result.body.push_back(measure_diagonal(*cell, d, kDiagonalPoints, {}, unused));
  }
  for (const Diagonal& d : face_diagonals(bench.box)) {
    result.face.push_back(measure_diagonal(*cell, d, kDiagonalPoints, {}, unused));
  }
  result.pnp_on_knots =
      measure_diagonal(*cell, body_diagonals(bench.box)[kPnp], kKnotPoints, {}, unused);
  result.volume = measure_volume(*cell, bench.box, bench.options.volume_points, bench.options.seed);
  return result;
}

double measure_pnp(const TrueMachine& truth, const Bench& bench,
                   const std::vector<std::uint8_t>& image, const InterferometerSetup& setup,
                   Random& random) {
  const auto cell = bench.options.make_cell(truth, bench.machine.correction, image);
  cell->place(bench.box.lo);
  return measure_diagonal(*cell, body_diagonals(bench.box)[kPnp], kDiagonalPoints, setup, random)
      .max_abs_um;
}

// The files behind the tables that the report shows, while they are there.
void note_inputs(const Campaign& campaign, const Commissioned& tables, XyfzResult& result) {
  result.inputs = {hashed_file("machine file", result.options.machine)};
  for (const RunsFile& runs : campaign.runs)
    result.inputs.push_back(hashed_file(fmt::format("runs of {}", runs.letter), runs.name));
  result.inputs.push_back(
      hashed_bytes("table image made of them", "tables.vct", make_image(tables.tables)));
}

std::uint64_t draw_seed(std::uint64_t seed, std::size_t draw) { return seed * 1'000'003U + draw; }

DrawResult run_draw(const Bench& bench, std::size_t draw, XyfzResult& result) {
  const NoiseClasses classes;
  Random random(draw_seed(bench.options.seed, draw));
  const Campaign measured =
      measure_machine(bench.truth, bench.machine, classes, bench.options.runs, random);
  const Campaign campaign =
      through_files(measured, bench.folder / fmt::format("draw_{:03}", draw + 1));

  TrueMachine at_check = bench.truth;
  at_check.temperature_offset_K = random.normal(classes.temperature_K);
  const InterferometerSetup setup{random.normal(classes.interferometer), classes.repeatability_mm,
                                  static_cast<int>(bench.options.runs)};
  DrawResult out;
  out.raw_um = measure_pnp(at_check, bench, {}, setup, random);
  for (std::size_t m = 0; m < kModels.size(); ++m) {
    auto tables =
        commission(campaign.machine, campaign.runs, tables_only(kModels[m], bench.options.knots));
    out.residual_um[m] = measure_pnp(at_check, bench, make_image(tables->tables), setup, random);
    const bool keep = draw == 0 && kModels[m] == ModelKind::abbe_closed;
    if (!keep) continue;
    result.positioning.clear();
    for (const auto& built : tables->built)
      result.positioning.push_back(built->positioning);
    result.warnings = tables->warnings;
    note_inputs(campaign, *tables, result);
    result.example = std::move(tables);
  }
  return out;
}

PerAxisRemainder per_axis_remainder(const Commissioned& closed) {
  const auto error_at = [&](const Vec3& q) {
    return closed.model.first_order({q.x(), q.y(), q.z()}, kUnknownTravels, Beyond::stand_at_end);
  };
  std::array<KnotGrid, 3> grid;
  for (std::size_t a = 0; a < 3; ++a) {
    const ErrorTable& measured = closed.built[a]->table;
    grid[a] = {measured.q0, measured.pitch, std::min(measured.knots, kPerAxisKnots)};
  }
  PerAxisTables<kPerAxisKnots> tables;
  per_axis_grid_mean(error_at, grid, tables);
  return {tables.residual_max * kUmPerMm, tables.residual_rms * kUmPerMm};
}

// Where a customer looks, before and after.
void look_closer(const Bench& bench, const Commissioned& closed, XyfzResult& result) {
  const NoiseClasses classes;
  Random random(bench.options.seed);
  const InterferometerSetup setup{0.0, classes.repeatability_mm,
                                  static_cast<int>(bench.options.runs)};
  result.volume_points = volume_grid(bench.box);
  for (const bool after : {false, true}) {
    const auto cell =
        bench.options.make_cell(bench.truth, bench.machine.correction,
                                after ? make_image(closed.tables) : std::vector<std::uint8_t>{});
    cell->place(bench.box.lo);
    result.volume_error.at(after ? 1 : 0) = measure_errors(*cell, result.volume_points);
    for (Positioning& axis :
         measure_positioning(*cell, bench.machine, after ? "after" : "before", setup, random))
      result.positioning_check.push_back(std::move(axis));
  }
}

// Modes verified without noise; returns the closed model for what follows.
std::unique_ptr<Commissioned> run_noise_free(const Bench& bench, const Progress& progress,
                                             XyfzResult& result) {
  const Campaign campaign =
      through_files(perfect_campaign(bench.truth, bench.machine), bench.folder / "noise_free");
  progress(0.0, "uncompensated machine");
  result.mode[0] = verify_mode(bench, {});
  std::unique_ptr<Commissioned> closed;
  for (std::size_t m = 0; m < kModels.size(); ++m) {
    progress(0.05 * static_cast<double>(m + 1), fmt::format("verifying {}", kModeNames[m + 1]));
    CommissionOptions options;
    options.model = kModels[m];
    options.knots = bench.options.knots;
    auto tables = commission(campaign.machine, campaign.runs, options);
    result.mode[m + 1] = verify_mode(bench, make_image(tables->tables));
    result.mode[m + 1].model_bound_nm = tables->model_bound_nm;
    closed = std::move(tables);
  }
  note_inputs(campaign, *closed, result);
  return closed;
}

}  // namespace

double ModeResult::faces_max_um() const {
  double worst = 0.0;
  for (const MeasuredDiagonal& d : face)
    worst = std::max(worst, d.max_abs_um);
  return worst;
}

double DrawResult::rate(std::size_t model) const {
  return improvement_percent(raw_um, residual_um.at(model));
}

double XyfzResult::rate(std::size_t m) const {
  return improvement_percent(mode[0].body[kPnp].max_abs_um, mode.at(m).body[kPnp].max_abs_um);
}

double XyfzResult::rate_on_knots(std::size_t m) const {
  return improvement_percent(mode[0].pnp_on_knots.max_abs_um, mode.at(m).pnp_on_knots.max_abs_um);
}

double XyfzResult::draw_quantile(std::size_t model, double fraction) const {
  std::vector<double> rates;
  for (const DrawResult& d : draws)
    rates.push_back(d.rate(model));
  std::sort(rates.begin(), rates.end());
  const double place = fraction * static_cast<double>(rates.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  const double next = i + 1 < rates.size() ? rates[i + 1] : rates[i];
  return rates[i] + (place - static_cast<double>(i)) * (next - rates[i]);
}

double XyfzResult::draws_reaching(double wanted) const {
  const auto reached = std::count_if(draws.begin(), draws.end(),
                                     [&](const DrawResult& d) { return d.rate(2) >= wanted; });
  return static_cast<double>(reached) / static_cast<double>(draws.size());
}

XyfzResult run_xyfz(const XyfzOptions& options, const Progress& progress) {
  XyfzResult result;
  result.options = options;
  result.machine = read_machine_file(options.machine);
  progress(0.0, "tuning the simulated machine");
  result.tuning = tune_xyfz(result.machine, options.machine_seed);

  const TemporaryFolder temporary;
  const Bench bench{
      options, result.machine, make_xyfz_truth(result.machine, options.machine_seed, result.tuning),
      travel_box(result.machine), options.campaign.empty() ? temporary.path() : options.campaign};
  std::unique_ptr<Commissioned> closed = run_noise_free(bench, progress, result);
  progress(0.2, "line and circle");
  result.dynamics = run_dynamics(bench.truth, bench.machine, *closed, options.make_cell);
  look_closer(bench, *closed, result);
  result.tick_max_error_nm = measure_tick_error_nm(*closed, options.tick_points, options.seed);
  result.per_axis = per_axis_remainder(*closed);
  Random lever_noise(options.seed);
  result.levers =
      check_levers(bench.truth, bench.machine, NoiseClasses{}, options.runs, lever_noise);
  for (const auto& built : closed->built)
    result.positioning.push_back(built->positioning);
  result.example = std::move(closed);
  for (std::size_t d = 0; d < options.draws; ++d) {
    progress(0.25 + 0.75 * static_cast<double>(d) / static_cast<double>(options.draws),
             fmt::format("noisy campaign {} of {}", d + 1, options.draws));
    result.draws.push_back(run_draw(bench, d, result));
  }
  progress(1.0, "done");
  return result;
}

}  // namespace volcomp::sim
