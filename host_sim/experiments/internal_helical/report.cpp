#include "host_sim/experiments/internal_helical/report.hpp"

#include <utility>

#include <fmt/format.h>

#include "host_sim/experiments/internal_helical/charts.hpp"
#include "host_sim/experiments/internal_helical/figures.hpp"
#include "host_sim/experiments/internal_helical/signals.hpp"
#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::internal_helical {
namespace {

using nlohmann::json;

std::string grade_text(const GearGrade& g) {
  return g.grade ? std::to_string(*g.grade) : fmt::format(">{}", last_grade(g.standard));
}

json measure_table(const InternalHelicalResult& run) {
  json rows = json::array();
  for (const HelicalMeasure& m : helical_measures(run)) {
    const EvaluationRange allowed = m.allowed();
    json row = {m.name,
                m.side,
                m.after ? "after" : "before",
                m.found.median,
                m.found.min,
                m.found.max,
                "–",
                "–",
                grade_text(helical_grade(run.job, m, GearStandard::iso1328_1995)),
                grade_text(helical_grade(run.job, m, GearStandard::iso1328_2013)),
                nullptr};
    if (m.same_gear && run.options.scatters()) {
      row[6] = fmt::format("{:.1f} … {:.1f}", allowed.low, allowed.high);
      row[7] = m.ok() ? "yes" : "NO";
    }
    if (m.same_gear) row[10] = m.paper;
    rows.push_back(row);
  }
  return host::in_summary(host::with_id(
      "deviations",
      host::table_section(
          "Deviations over the seeds",
          {host::plain_column("deviation"), host::plain_column("flank"), host::plain_column(""),
           host::column("median", "µm", 1), host::column("min", "µm", 1),
           host::column("max", "µm", 1), host::plain_column("median allowed, µm"),
           host::plain_column("within"), host::plain_column("grade 1995"),
           host::plain_column("2013"), host::column("paper", "µm", 1)},
          rows),
      "Grades of the medians by ISO 1328-1, rounded tolerances. The allowed range is that of an "
      "independent simulation, widened by 25 %; the paper measured one gear of each."));
}

// What was found besides the deviations, in words.
json found_text(const InternalHelicalResult& run) {
  std::string curve = "synchronisation, µm rms on the flank, round by round:";
  for (const double um : learning_curve(run))
    curve += fmt::format(" {:.2f}", um);
  std::vector<std::string> lines{
      fmt::format(
          "gear: {} teeth, module {:g}, helix {:g} deg, width {:g} mm; {} seeds, learned {}",
          run.gear.teeth, run.gear.module, run.gear.helix_angle / kRadPerDegree, run.job.width_mm,
          run.options.seeds, kLearningWays.at(static_cast<std::size_t>(run.options.way))),
      fmt::format("wheel of 17 knots: flank within {:.3f} nm; first order against the exact "
                  "envelope: {:.1f} nm for one error, {:.1f} nm for all at once (95 of 100)",
                  run.geometry.regenerated_nm, run.geometry.single_nm, run.geometry.all_nm),
      fmt::format("lags on the flank: Z alone {:.1f} µm, C alone {:.1f} µm, together {:.2f} µm",
                  run.lags.z_um, run.lags.c_um, run.lags.together_um)};
  for (std::string& line : signal_lines(run))
    lines.push_back(std::move(line));
  lines.push_back(
      fmt::format("largest error of Z: {:.3f} mm before, {:.3f} mm after: the helix "
                  "goes on lagging, in step",
                  z_peak_spread(run, false).median, z_peak_spread(run, true).median));
  lines.push_back(curve);
  return host::in_summary(
      host::with_id("found", host::text_section("Gear, wheel and signals", lines)));
}

json truth_table(const InternalHelicalResult& run) {
  const GrindingTruth& t = run.options.truth;
  json rows = json::array();
  const auto row = [&rows](const char* what, double value, const char* unit, const char* seen) {
    rows.push_back({what, value, unit, seen});
  };
  row("gain of the position loop of Z", t.gain_z, "1/s", "yes");
  row("gain of the position loop of C", t.gain_c, "1/s", "yes");
  row("ripple of Z", kUmPerMm * t.ripple_mm, "µm", "yes");
  row("its wavelength", t.ripple_wavelength_mm, "mm", "yes");
  row("C once per turn", host::kUradPerRad * t.visible_rad, "µrad", "yes");
  row("C, another one in every slot, rms", host::kUradPerRad * t.slot_rms_rad, "µrad", "yes");
  row("C, another one in every pass, rms", host::kUradPerRad * t.pass_rms_rad, "µrad",
      "yes, not repeatable");
  row("X, another one in every pass, rms", kUmPerMm * t.hunting_rms_mm, "µm",
      "yes, not repeatable");
  row("C once per turn", host::kUradPerRad * t.invisible_rad, "µrad", "no");
  row("run-out of the workpiece", kUmPerMm * t.runout_mm, "µm", "no");
  row("slope of the wheel on the profile", kUmPerMm * t.wheel_form_mm, "µm", "no");
  row("probe, per point, rms", kUmPerMm * t.probe_mm, "µm", "no");
  return host::with_id(
      "truth",
      host::table_section("The machine, as chosen here",
                          {host::plain_column("what"), host::column("amount", "", 1),
                           host::plain_column("unit"), host::plain_column("seen by the encoders")},
                          rows),
      fmt::format(
          "The paper publishes none of it: amounts are chosen so that the sums land at its printed "
          "deviations. The run shows a mechanism that is consistent with them, it does not verify "
          "the experiment. Angles of the waves once per turn are chosen as well, so that left and "
          "right F_p differ as specified: the visible one {:g}° behind the invisible one, run-out "
          "towards {:g}°.",
          t.visible_phase / kRadPerDegree, t.runout_phase / kRadPerDegree));
}

std::string grade_word(const InternalHelicalResult& run, const HelicalMeasure& m) {
  return grade_text(helical_grade(run.job, m, GearStandard::iso1328_1995));
}

json before_after(const InternalHelicalResult& run) {
  std::vector<host::BeforeAfter> lines{{"Z and C out of step on the flank, rms",
                                        sync_spread(run, false).median,
                                        sync_spread(run, true).median}};
  const std::vector<HelicalMeasure> measures = helical_measures(run);  // before, after, before …
  for (std::size_t i = 0; i + 1 < measures.size(); i += 2) {
    const HelicalMeasure& before = measures[i];
    const HelicalMeasure& after = measures[i + 1];
    lines.push_back({fmt::format("{} {}", before.name, before.side), before.found.median,
                     after.found.median, std::nullopt, grade_word(run, before),
                     grade_word(run, after)});
  }
  return host::before_after_table(
      lines,
      fmt::format("Medians of {} simulated grinders: the first gear, ground "
                  "with no offsets, and the last, after {} updates. Grades "
                  "by ISO 1328-1:1995.",
                  run.options.seeds, run.options.updates),
      0);
}

host::Origins origins(const InternalHelicalResult& run) {
  host::Origins origins;
  origins.settings = {{"learned", kLearningWays.at(static_cast<std::size_t>(run.options.way))},
                      {"seeds", fmt::format("1 to {}; curves are of seed 1", run.options.seeds)}};
  origins.inputs = run.inputs;
  origins.instruments = {fmt::format("encoders of the machine: steps of {:g} µm and {:g} µrad",
                                     kUmPerMm * run.options.truth.resolution_z_mm,
                                     host::kUradPerRad * run.options.truth.resolution_c_rad),
                         fmt::format("measuring machine for the gear: {:g} µm rms of every point",
                                     kUmPerMm * run.options.truth.probe_mm)};
  origins.chosen = {
      "amounts and angles of what disturbs the grinder, so that the sums land at the deviations "
      "the "
      "paper prints"};
  origins.untouched = {"what is learned, and the deviations after it"};
  return origins;
}

}  // namespace

json internal_helical_document(const InternalHelicalResult& result, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "Internal helical gear: grinding watched and compensated";
  parts.subtitle = fmt::format(
      "{} teeth, module {:g}, helix {:g}°, width {:g} mm; offsets of C learned in "
      "{} updates",
      result.gear.teeth, result.gear.module, result.gear.helix_angle / kRadPerDegree,
      result.job.width_mm, result.options.updates);
  parts.verdict = internal_helical_verdict(result);
  parts.before_after = before_after(result);
  parts.plots = {tracking_charts(result), learning_chart(result), cumulative_pitch_charts(result)};
  for (std::size_t side = 0; side < kHelicalSides.size(); ++side)
    parts.plots.push_back(single_pitch_chart(result, side));
  parts.plots.push_back(profile_charts(result));
  parts.details = {measure_table(result),      found_text(result),       lag_charts(result),
                   slot_chart(result),         spectrum_along_z(result), spectrum_around_c(result),
                   stroke_table_chart(result), slot_table_chart(result), truth_table(result)};
  parts.ticks = run.ticks;
  parts.provenance = host::provenance(run, origins(result));
  return host::report_document(std::move(parts));
}

std::string internal_helical_summary(const InternalHelicalResult& result) {
  return host::terminal_text(internal_helical_document(result, {}));
}

}  // namespace volcomp::internal_helical
