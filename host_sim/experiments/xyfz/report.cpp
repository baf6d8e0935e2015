#include "host_sim/experiments/xyfz/report.hpp"

#include <fmt/format.h>

#include "host_sim/experiments/xyfz/charts.hpp"
#include "host_sim/experiments/xyfz/dynamics.hpp"
#include "host_sim/experiments/xyfz/truth.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/sim/instruments/circular_ball_bar.hpp"

namespace volcomp::xyfz {
namespace {

using nlohmann::json;

json before_after(const XyfzResult& r) {
  std::vector<host::BeforeAfter> lines;
  const ModeResult& before = r.mode.front();
  const ModeResult& after = r.mode.back();
  for (std::size_t d = 0; d < before.body.size(); ++d)
    lines.push_back({fmt::format("body diagonal {}, largest deviation", before.body[d].name),
                     before.body[d].max_abs_um, after.body[d].max_abs_um});
  lines.push_back(
      {"face diagonals, largest deviation", before.faces_max_um(), after.faces_max_um()});
  lines.push_back({"volume, largest deviation", before.volume.max_um, after.volume.max_um});
  for (std::size_t a = 0; a < 3; ++a)
    lines.push_back({fmt::format("positioning of {}, A", r.machine.axes[a].letter),
                     kUmPerMm * r.positioning_check[a].figures.A,
                     kUmPerMm * r.positioning_check[a + 3].figures.A});
  return host::before_after_table(
      lines,
      fmt::format("Diagonals and volume noise-free: each diagonal at {} points in both directions, "
                  "the volume at {} random points after aligning the workpiece frame. Positioning "
                  "after ISO 230-2 with {} bidirectional runs of an interferometer. The machine "
                  "moved with the offsets applied; nothing was subtracted afterwards.",
                  sim::kDiagonalPoints, r.options.volume_points, r.options.runs),
      sim::kPnp);
}

json models_table(const XyfzResult& r) {
  json rows = json::array();
  for (std::size_t m = 0; m < r.mode.size(); ++m) {
    json row = {kModeTitles[m]};
    for (const sim::MeasuredDiagonal& d : r.mode[m].body)
      row.push_back(d.max_abs_um);
    row.push_back(r.mode[m].faces_max_um());
    row.push_back(r.mode[m].volume.max_um);
    row.push_back(m == 0 ? json(nullptr) : json(r.rate(m)));
    row.push_back(m == 0 ? json(nullptr) : json(r.rate_on_knots(m)));
    rows.push_back(row);
  }
  json columns = json::array({host::plain_column("largest deviation")});
  for (const char* name : {"PPP", "NPP", "PNP", "PPN", "faces", "volume"})
    columns.push_back(host::column(name, "µm", 2));
  columns.push_back(host::column("rate PNP", "%", 2));
  columns.push_back(host::column("on knots", "%", 2));
  json table = host::table_section("The models beside each other", columns, rows);
  table["highlight_row"] = 3;
  return host::in_summary(host::with_id(
      "models", table,
      fmt::format("Largest deviation of each diagonal at {} points, of the six face diagonals, and "
                  "in the volume at {} random points after aligning the workpiece frame. Rate: "
                  "reduction of the PNP maximum; a single diagonal certifies nothing, look at all "
                  "of them.",
                  sim::kDiagonalPoints, r.options.volume_points)));
}

json lever_table(const XyfzResult& r) {
  json rows = json::array();
  for (const sim::LeverCheck& c : r.levers) {
    for (std::size_t k = 0; k < 2; ++k) {
      rows.push_back({fmt::format("{}, angle {}", c.axis, k + 1), c.test.expected[k],
                      c.test.found[k], c.test.allowed[k],
                      c.status.ok() ? "good" : code(c.status.reason)});
    }
  }
  return host::with_id(
      "levers",
      host::table_section("Lever self-test",
                          {host::plain_column("axis"), host::column("lever difference", "mm", 1),
                           host::column("found", "mm", 1), host::column("allowed", "mm", 1),
                           host::plain_column("result")},
                          rows),
      "Positioning measured at two places: the difference regressed on the angles must return the "
      "lever difference. A wrong sign, unit or order of axes cannot pass.");
}

json limits_table(const XyfzResult& r) {
  json rows = json::array(
      {{"tick against the same model in double, after rounding", r.tick_max_error_nm, "nm"},
       {fmt::format("applied against wanted offset at {:g} m/min", kLineFeed_m_min),
        r.dynamics.line_worst_nm, "nm"},
       {"first-order run-time model against the exact chain", r.mode[3].model_bound_nm, "nm"}});
  for (Eigen::Index a = 0; a < 3; ++a)
    rows.push_back({fmt::format("not representable by one-dimensional tables, {}", "XYZ"[a]),
                    r.per_axis.max_um(a), "µm"});
  return host::in_summary(host::with_id(
      "limits", host::table_section("What the arithmetic and the models leave",
                                    {host::plain_column("quantity"), host::column("value", "", 3),
                                     host::plain_column("unit")},
                                    rows)));
}

std::string ball_bar(const sim::NoiseClasses& n, Functional functional) {
  if (functional == Functional::lines)
    return fmt::format("ball bar for squareness along lines: {:g} µrad",
                       host::kUradPerRad * n.ball_bar_rad);
  const sim::BallBarClass bar =
      n.ball_bar_rad > 0.0 ? sim::BallBarClass{} : sim::perfect_ball_bar();
  return fmt::format(
      "ball bar for squareness, two circles each way of {:g} mm: reading {:g} µm, socket {:g} µm, "
      "start {:g} mrad, length {:g} µm, sensor ± {:g} µm",
      kBallBar_mm, kUmPerMm * bar.reading, kUmPerMm * bar.centre, 1e3 * bar.start_angle,
      kUmPerMm * bar.length, kUmPerMm * bar.sensor);
}

std::string laser(const sim::NoiseClasses& n, std::size_t runs) {
  return fmt::format(
      "laser of six degrees of freedom, {} bidirectional runs: repeatability {:g} µm and {:g} "
      "µrad, "
      "scale {:g} µm/m, beam within ± {:g} mrad, waves of {:g} µm and {:g} µrad, levers known to "
      "{:g} mm; roll by {}",
      runs, kUmPerMm * n.repeatability_mm, host::kUradPerRad * n.repeatability_rad,
      host::kUradPerRad * n.scale, 1e3 * n.beam_rad, kUmPerMm * n.straightness_wave_mm,
      host::kUradPerRad * n.angle_wave_rad, n.arm_mm,
      n.laser.roll_by_level ? "a level, of Z by the laser"
                            : fmt::format("the laser, {:g} µrad", host::kUradPerRad * n.roll_rad));
}

std::string surroundings(const sim::NoiseClasses& n) {
  return fmt::format(
      "lengths drift ({}, {:g} µm, {:g} s; a reading every {:g} s); while it is measured each axis "
      "is warmer by {:g} K, at the check the machine by {:g} K",
      host::kDriftNames.at(n.laser.drift), kUmPerMm * n.laser.drift_mm, n.laser.drift_tau_s,
      n.laser.dwell_s, n.laser.growth_K, n.temperature_K);
}

host::Origins origins(const XyfzResult& r) {
  host::Origins o;
  o.data = "simulated: no machine was measured; the paper's own curves are not available";
  o.settings = {
      {"noise seed", std::to_string(r.options.seed)},
      {"machine seed", fmt::format("{} (phases of the error functions)", r.options.machine_seed)},
      {"noisy campaigns", std::to_string(r.options.draws)}};
  o.inputs = r.inputs;
  o.instruments = instruments_of(r.options, r.noise);
  for (const auto& text : tuned_text(r.tuning))
    o.tuned.push_back(text);
  o.chosen = {
      "amplitudes of the error functions by class; squareness so that a perfect ball bar "
      "reads the values of the machine file"};
  o.untouched = {
      "the residuals of the two Abbe models, the other diagonals, faces, volume and positioning"};
  o.warnings = r.warnings;
  return o;
}

}  // namespace

json tuned_text(const XyfzTuning& tuning) {
  return {fmt::format("angle scale {:.4f} so that the naive residual on PNP is {} µm",
                      tuning.angle_scale, kPaperNaive_um),
          fmt::format("scale error of X {:.3e} so that PNP reads {} µm uncompensated",
                      tuning.scale_error, kPaperRaw_um)};
}

std::vector<std::string> instruments_of(const XyfzOptions& options, const sim::NoiseClasses& n) {
  std::vector<std::string> texts{laser(n, options.runs), surroundings(n),
                                 ball_bar(n, options.noisy),
                                 fmt::format("interferometer along diagonals: scale {:g} µm/m",
                                             host::kUradPerRad * n.interferometer)};
  if (options.only)
    texts.insert(texts.begin(), fmt::format("everything is perfect but {}", name_of(options.only)));
  return texts;
}

host::Verdict noise_free_verdict(const XyfzResult& r) {
  host::Verdict v;
  v.ok = r.rate(3) >= 98.0 && r.dynamics.line_is_good() && r.tick_max_error_nm < 1.0;
  v.text =
      fmt::format("PNP diagonal {:.2f} µm before, {:.2f} µm after ({:.1f} % less, noise-free).",
                  r.mode[0].body[2].max_abs_um, r.mode[3].body[2].max_abs_um, r.rate(3));
  return v;
}

void add_draw_verdict(const XyfzResult& r, host::Verdict& v) {
  if (r.draws.empty()) return;
  const double median = r.draw_quantile(2, 0.5);
  v.ok = v.ok && median >= kPaperRate;
  v.text += fmt::format(
      " With realistic instruments {:.1f} % (median of {}; 5 % of them below {:.1f} %), the "
      "paper's {} % reached in {:.0f} %.",
      median, r.draws.size(), r.draw_quantile(2, 0.05), kPaperRate,
      100.0 * r.draws_reaching(kPaperRate));
}

host::Verdict xyfz_verdict(const XyfzResult& r) {
  host::Verdict v = noise_free_verdict(r);
  add_draw_verdict(r, v);
  return v;
}

void add_draw_figures(const XyfzResult& r, json& figures) {
  if (r.draws.empty()) return;
  for (std::size_t m = 1; m < kModeNames.size(); ++m)
    figures["draws"]["rate"][kModeNames[m]] = {{"median", r.draw_quantile(m - 1, 0.5)},
                                               {"p05", r.draw_quantile(m - 1, 0.05)}};
  figures["draws"]["count"] = r.draws.size();
  figures["draws"]["abbe_closed_reaching_paper"] = r.draws_reaching(kPaperRate);
}

json xyfz_figures(const XyfzResult& r) {
  json j = noise_free_figures(r);
  add_draw_figures(r, j);
  return j;
}

json noise_free_figures(const XyfzResult& r) {
  json j;
  for (std::size_t m = 0; m < r.mode.size(); ++m) {
    for (const sim::MeasuredDiagonal& d : r.mode[m].body)
      j["diagonals_um"][kModeNames[m]][d.name] = d.max_abs_um;
    j["faces_max_um"][kModeNames[m]] = r.mode[m].faces_max_um();
    j["volume_max_um"][kModeNames[m]] = r.mode[m].volume.max_um;
    if (m == 0) continue;
    j["rate"][kModeNames[m]] = r.rate(m);
    j["rate_on_knots"][kModeNames[m]] = r.rate_on_knots(m);
  }
  j["line_worst_nm"] = r.dynamics.line_worst_nm;
  j["per_axis_remainder_um"] = {r.per_axis.max_um.x(), r.per_axis.max_um.y(),
                                r.per_axis.max_um.z()};
  j["tick"]["max_error_nm"] = r.tick_max_error_nm;
  j["model_bound_nm"] = r.mode[3].model_bound_nm;
  j["seed"] = r.options.seed;
  j["machine_seed"] = r.options.machine_seed;
  j["tuned"] = tuned_text(r.tuning);
  j["version"] = host::kVersion;
  return j;
}

json xyfz_document(const XyfzResult& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "XYFZ machine: volumetric compensation";
  parts.subtitle =
      "Simulated three-axis machine after Zhao et al. 2020, measured, tabled, compensated, "
      "measured again";
  parts.verdict = xyfz_verdict(r);
  parts.before_after = before_after(r);
  parts.plots = {diagonal_charts(r, false), volume_chart(r), positioning_charts(r),
                 error_function_charts(r)};
  parts.details = {models_table(r), limits_table(r), diagonal_charts(r, true)};
  for (const json& s : draws_sections(r))
    parts.details.push_back(s);
  for (const json& s : dynamics_sections(r))
    parts.details.push_back(s);
  parts.details.push_back(host::positioning_table(
      r.positioning_check, "At mid travel of the other axes, by interferometer."));
  parts.details.push_back(lever_table(r));
  parts.ticks = run.ticks;
  parts.provenance = host::provenance(run, origins(r));
  return host::report_document(std::move(parts));
}

std::string xyfz_summary(const XyfzResult& r) { return host::terminal_text(xyfz_document(r, {})); }

}  // namespace volcomp::xyfz
