#include "host_sim/experiments/xyfz/scenario.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "comp/metrology/tables/per_axis.hpp"
#include "host_sim/experiments/xyfz/dynamics.hpp"
#include "host_sim/experiments/xyfz/noisy_campaign.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/report/shared_progress.hpp"
#include "host_sim/sim/campaign/measured_positions.hpp"

namespace volcomp::xyfz {
namespace {

constexpr std::size_t kPerAxisKnots = 32;

ModeResult verify_mode(const Bench& bench, const std::vector<std::uint8_t>& image) {
  sim::Random unused(0);
  const auto cell = bench.cell(bench.truth, image);
  const auto measured = [&](const Diagonal& d, std::size_t points) {
    return sim::measure_diagonal(*cell, d, points, {}, unused);
  };
  ModeResult result;
  for (const Diagonal& d : body_diagonals(bench.box))
    result.body.push_back(measured(d, sim::kDiagonalPoints));
  for (const Diagonal& d : face_diagonals(bench.box))
    result.face.push_back(measured(d, sim::kDiagonalPoints));
  result.pnp_on_knots = measured(body_diagonals(bench.box)[sim::kPnp], sim::kKnotPoints);
  result.volume = host::aligned_volume_figures(sim::visit_volume(
      *cell, host::XyzAxes(bench.machine), bench.options.volume_points, bench.options.seed));
  return result;
}

// The files behind the tables that the report shows, while they are there.
void note_inputs(const sim::Campaign& campaign, const host::BuiltTables& tables,
                 XyfzResult& result) {
  result.inputs = {host::hashed_file("machine file", result.options.machine)};
  for (const host::RunsFile& runs : campaign.runs)
    result.inputs.push_back(host::hashed_file(fmt::format("runs of {}", runs.letter), runs.name));
  result.inputs.push_back(host::hashed_bytes("table image made of them", "tables.vct",
                                             host::make_image(tables.tables)));
}

// The report shows this campaign.
void keep_example(const sim::Campaign& campaign, std::unique_ptr<host::BuiltTables> closed,
                  XyfzResult& result) {
  result.positioning.clear();
  for (const auto& built : closed->built)
    result.positioning.push_back(built->positioning);
  result.warnings = closed->warnings;
  note_inputs(campaign, *closed, result);
  result.example = std::move(closed);
}

PerAxisRemainder per_axis_remainder(const host::BuiltTables& closed) {
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

// Measures what an acceptance test measures, before and after.
void look_closer(const Bench& bench, const host::BuiltTables& closed, XyfzResult& result) {
  const sim::NoiseClasses classes = bench.noise();
  sim::Random random(bench.options.seed);
  const sim::InterferometerSetup setup{0.0, classes.repeatability_mm,
                                       static_cast<int>(bench.options.runs)};
  result.volume_points = sim::volume_grid(bench.box);
  for (const bool after : {false, true}) {
    const auto cell = bench.cell(
        bench.truth, after ? host::make_image(closed.tables) : std::vector<std::uint8_t>{});
    result.volume_error.at(after ? 1 : 0) = sim::measure_errors(*cell, result.volume_points);
    for (host::Positioning& axis :
         sim::measure_positioning(*cell, bench.machine, after ? "after" : "before", setup, random))
      result.positioning_check.push_back(std::move(axis));
  }
}

// `result` receives each draw at its place; only the first one touches anything else in it.
void run_draws(const Bench& bench, const std::filesystem::path& folder,
               const host::Progress& progress, XyfzResult& result) {
  const std::size_t draws = bench.options.draws;
  const std::vector<std::size_t> own = bench.options.shard.draws_of(draws);
  result.draws.resize(own.size());
  host::SharedProgress shared(progress, own.size(), 0.25);
  host::in_parallel(own.size(), bench.options.threads, [&](std::size_t i) {
    const std::string what = fmt::format("noisy campaign {} of {}", own[i] + 1, draws);
    shared.show(i, 0.0, what);
    CheckedCampaign measured =
        noisy_campaign(bench, folder / fmt::format("draw_{:03}", own[i] + 1), own[i]);
    Compensated compensated = compensate(bench, measured);
    result.draws[i] = compensated.pnp;
    if (own[i] == 0) keep_example(measured.campaign, std::move(compensated.closed), result);
    shared.show(i, 1.0, what);
  });
}

// Modes verified without noise; returns the closed model for what follows.
std::unique_ptr<host::BuiltTables> run_noise_free(const Bench& bench,
                                                  const std::filesystem::path& folder,
                                                  const host::Progress& progress,
                                                  XyfzResult& result) {
  const sim::Campaign campaign =
      through_files(sim::perfect_campaign(bench.truth, bench.machine), folder / "noise_free");
  std::array<std::unique_ptr<host::BuiltTables>, kModels.size()> tables;
  host::SharedProgress shared(progress, result.mode.size(), 0.0, 0.2);
  host::in_parallel(result.mode.size(), bench.options.threads, [&](std::size_t mode) {
    shared.show(mode, 0.0, fmt::format("verifying {}", kModeNames[mode]));
    std::vector<std::uint8_t> image;  // none: the uncompensated machine
    if (mode > 0) {
      host::BuildOptions options;
      options.model = kModels[mode - 1];
      options.knots = bench.options.knots;
      tables[mode - 1] = host::build_tables(campaign.machine, campaign.runs, options);
      image = host::make_image(tables[mode - 1]->tables);
    }
    result.mode[mode] = verify_mode(bench, image);
    if (mode > 0) result.mode[mode].model_bound_nm = tables[mode - 1]->model_bound_nm;
    shared.show(mode, 1.0, fmt::format("verifying {}", kModeNames[mode]));
  });
  std::unique_ptr<host::BuiltTables> closed = std::move(tables.back());
  note_inputs(campaign, *closed, result);
  return closed;
}

}  // namespace

double ModeResult::faces_max_um() const {
  double worst = 0.0;
  for (const sim::MeasuredDiagonal& d : face)
    worst = std::max(worst, d.max_abs_um);
  return worst;
}

double XyfzResult::rate(std::size_t m) const {
  return improvement_percent(mode[0].body[sim::kPnp].max_abs_um,
                             mode.at(m).body[sim::kPnp].max_abs_um);
}

double XyfzResult::rate_on_knots(std::size_t m) const {
  return improvement_percent(mode[0].pnp_on_knots.max_abs_um, mode.at(m).pnp_on_knots.max_abs_um);
}

double XyfzResult::draw_quantile(std::size_t model, double fraction) const {
  return rate_quantile(draws, model, fraction);
}

double XyfzResult::draws_reaching(double wanted) const { return share_reaching(draws, 2, wanted); }

XyfzResult run_xyfz(const XyfzOptions& options, const host::Progress& progress) {
  XyfzResult result;
  result.options = options;
  const Bench bench(options, progress);
  result.machine = bench.machine;
  result.tuning = bench.tuning;
  result.noise = bench.noise();
  const host::TemporaryFolder temporary;
  const std::filesystem::path& folder =
      options.campaign.empty() ? temporary.path() : options.campaign;
  std::unique_ptr<host::BuiltTables> closed = run_noise_free(bench, folder, progress, result);
  progress(0.2, "line and circle");
  result.dynamics = run_dynamics(bench.truth, bench.machine, *closed, options.make_cell);
  look_closer(bench, *closed, result);
  result.tick_max_error_nm = measure_tick_error_nm(*closed, options.tick_points, options.seed);
  result.per_axis = per_axis_remainder(*closed);
  result.levers =
      sim::check_levers(bench.truth, bench.machine, bench.noise(), options.runs, bench.draw(0));
  for (const auto& built : closed->built)
    result.positioning.push_back(built->positioning);
  result.example = std::move(closed);
  run_draws(bench, folder, progress, result);
  progress(1.0, "done");
  return result;
}

}  // namespace volcomp::xyfz
