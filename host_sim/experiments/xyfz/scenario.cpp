#include "host_sim/experiments/xyfz/scenario.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "comp/metrology/tables/per_axis.hpp"
#include "host_sim/experiments/xyfz/bench.hpp"
#include "host_sim/experiments/xyfz/dynamics.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/campaign/measured_positions.hpp"

namespace volcomp::xyfz {
namespace {

constexpr std::array<host::ModelKind, 3> kModels{host::ModelKind::naive, host::ModelKind::abbe,
                                                 host::ModelKind::abbe_closed};
constexpr std::size_t kPerAxisKnots = 32;

// Writes the runs to files and reads them back, as with a user's own data.
sim::Campaign through_files(const sim::Campaign& campaign, const std::filesystem::path& folder) {
  host::create_folder(folder);
  sim::Campaign reread{campaign.machine, {}};
  for (const host::RunsFile& runs : campaign.runs) {
    const std::filesystem::path path = folder / runs.name;
    host::write_runs_file(path, runs);
    reread.runs.push_back(host::read_runs_file(path));
  }
  return reread;
}

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

std::uint64_t draw_seed(std::uint64_t seed, std::size_t draw) { return seed * 1'000'003U + draw; }

DrawResult run_draw(const Bench& bench, const std::filesystem::path& folder, std::size_t draw,
                    XyfzResult& result) {
  const sim::NoiseClasses classes;
  sim::Random random(draw_seed(bench.options.seed, draw));
  const sim::Campaign measured =
      sim::measure_machine(bench.truth, bench.machine, classes, bench.options.runs, random);
  const sim::Campaign campaign =
      through_files(measured, folder / fmt::format("draw_{:03}", draw + 1));

  sim::TrueMachine at_check = bench.truth;
  at_check.temperature_offset_K = random.normal(classes.temperature_K);
  const sim::InterferometerSetup setup{random.normal(classes.interferometer),
                                       classes.repeatability_mm,
                                       static_cast<int>(bench.options.runs)};
  const auto measure_um = [&](const std::vector<std::uint8_t>& image) {
    return bench.pnp(at_check, image, sim::kDiagonalPoints, setup, random).max_abs_um;
  };
  DrawResult out;
  out.raw_um = measure_um({});
  for (std::size_t m = 0; m < kModels.size(); ++m) {
    auto tables = host::build_tables(campaign.machine, campaign.runs,
                                     host::tables_only(kModels[m], bench.options.knots));
    out.residual_um[m] = measure_um(host::make_image(tables->tables));
    const bool keep = draw == 0 && kModels[m] == host::ModelKind::abbe_closed;
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
  const sim::NoiseClasses classes;
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

// Modes verified without noise; returns the closed model for what follows.
std::unique_ptr<host::BuiltTables> run_noise_free(const Bench& bench,
                                                  const std::filesystem::path& folder,
                                                  const host::Progress& progress,
                                                  XyfzResult& result) {
  const sim::Campaign campaign =
      through_files(sim::perfect_campaign(bench.truth, bench.machine), folder / "noise_free");
  progress(0.0, "uncompensated machine");
  result.mode[0] = verify_mode(bench, {});
  std::unique_ptr<host::BuiltTables> closed;
  for (std::size_t m = 0; m < kModels.size(); ++m) {
    progress(0.05 * static_cast<double>(m + 1), fmt::format("verifying {}", kModeNames[m + 1]));
    host::BuildOptions options;
    options.model = kModels[m];
    options.knots = bench.options.knots;
    auto tables = host::build_tables(campaign.machine, campaign.runs, options);
    result.mode[m + 1] = verify_mode(bench, host::make_image(tables->tables));
    result.mode[m + 1].model_bound_nm = tables->model_bound_nm;
    closed = std::move(tables);
  }
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

double DrawResult::rate(std::size_t model) const {
  return improvement_percent(raw_um, residual_um.at(model));
}

double XyfzResult::rate(std::size_t m) const {
  return improvement_percent(mode[0].body[sim::kPnp].max_abs_um,
                             mode.at(m).body[sim::kPnp].max_abs_um);
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

XyfzResult run_xyfz(const XyfzOptions& options, const host::Progress& progress) {
  XyfzResult result;
  result.options = options;
  const Bench bench(options, progress);
  result.machine = bench.machine;
  result.tuning = bench.tuning;
  const host::TemporaryFolder temporary;
  const std::filesystem::path& folder =
      options.campaign.empty() ? temporary.path() : options.campaign;
  std::unique_ptr<host::BuiltTables> closed = run_noise_free(bench, folder, progress, result);
  progress(0.2, "line and circle");
  result.dynamics = run_dynamics(bench.truth, bench.machine, *closed, options.make_cell);
  look_closer(bench, *closed, result);
  result.tick_max_error_nm = measure_tick_error_nm(*closed, options.tick_points, options.seed);
  result.per_axis = per_axis_remainder(*closed);
  sim::Random lever_noise(options.seed);
  result.levers =
      sim::check_levers(bench.truth, bench.machine, sim::NoiseClasses{}, options.runs, lever_noise);
  for (const auto& built : closed->built)
    result.positioning.push_back(built->positioning);
  result.example = std::move(closed);
  for (std::size_t d = 0; d < options.draws; ++d) {
    progress(0.25 + 0.75 * static_cast<double>(d) / static_cast<double>(options.draws),
             fmt::format("noisy campaign {} of {}", d + 1, options.draws));
    result.draws.push_back(run_draw(bench, folder, d, result));
  }
  progress(1.0, "done");
  return result;
}

}  // namespace volcomp::xyfz
