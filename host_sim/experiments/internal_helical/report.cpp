#include "host_sim/experiments/internal_helical/report.hpp"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host_sim/experiments/internal_helical/charts.hpp"
#include "host_sim/experiments/internal_helical/figures.hpp"
#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::internal_helical {
namespace {

using nlohmann::json;

json grade_cell(const GearGrade& grade) { return grade.grade ? json(*grade.grade) : json("none"); }

json measure_table(const InternalHelicalResult& run) {
  json rows = json::array();
  for (const HelicalMeasure& m : helical_measures(run)) {
    const EvaluationRange allowed = m.allowed();
    const std::string range =
        m.same_gear ? fmt::format("{:.1f}…{:.1f}", allowed.low, allowed.high) : "–";
    const json paper = m.same_gear ? json(m.paper) : json(nullptr);
    rows.push_back({fmt::format("{} {}", m.name, m.side), m.after ? "after" : "before",
                    m.found.median, m.found.min, m.found.max, range,
                    !m.same_gear ? "–"
                    : m.ok()     ? "yes"
                                 : "no",
                    grade_cell(helical_grade(run.job, m, GearStandard::iso1328_1995)),
                    grade_cell(helical_grade(run.job, m, GearStandard::iso1328_2013)), paper});
  }
  return {{"type", "table"},
          {"id", "deviations"},
          {"title", "Deviations over the seeds"},
          {"columns",
           {{{"title", "deviation"}},
            {{"title", ""}},
            host::column("median", "µm", 1),
            host::column("lowest", "µm", 1),
            host::column("highest", "µm", 1),
            {{"title", "allowed for the median, µm"}},
            {{"title", "within"}},
            host::column("grade 1995", "", 0),
            host::column("grade 2013", "", 0),
            host::column("paper", "µm", 1)}},
          {"rows", rows},
          {"note",
           "Grades of the medians by ISO 1328-1, rounded tolerances. The allowed range is that of "
           "an independent simulation, widened by 25 %; the paper measured one gear of each."}};
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
  row("C once per turn", 1e6 * t.visible_rad, "µrad", "yes");
  row("C, another one in every slot, rms", 1e6 * t.slot_rms_rad, "µrad", "yes");
  row("C, another one in every pass, rms", 1e6 * t.pass_rms_rad, "µrad", "yes, not repeatable");
  row("X, another one in every pass, rms", kUmPerMm * t.hunting_rms_mm, "µm",
      "yes, not repeatable");
  row("C once per turn", 1e6 * t.invisible_rad, "µrad", "no");
  row("run-out of the workpiece", kUmPerMm * t.runout_mm, "µm", "no");
  row("slope of the wheel on the profile", kUmPerMm * t.wheel_form_mm, "µm", "no");
  row("probe, per point, rms", kUmPerMm * t.probe_mm, "µm", "no");
  return {{"type", "table"},
          {"id", "truth"},
          {"title", "The machine, as chosen here"},
          {"columns",
           {{{"title", "what"}},
            host::column("amount", "", 1),
            {{"title", "unit"}},
            {{"title", "seen by the encoders"}}}},
          {"rows", rows},
          {"note",
           fmt::format(
               "The paper publishes none of it: amounts are chosen so that the sums land "
               "at its printed deviations. The run shows a mechanism that is consistent "
               "with them, it does not verify the experiment. Angles of the "
               "waves once per turn are chosen as well, so that left and right F_p differ as "
               "specified: the visible one {:g}° behind the invisible one, run-out towards {:g}°.",
               t.visible_phase / kRadPerDegree, t.runout_phase / kRadPerDegree)}};
}

std::string grade_word(const InternalHelicalResult& run, const HelicalMeasure& m) {
  const GearGrade grade = helical_grade(run.job, m, GearStandard::iso1328_1995);
  return grade.grade ? std::to_string(*grade.grade) : "none";
}

json before_after(const InternalHelicalResult& run) {
  std::vector<host::BeforeAfter> lines{{"Z and C out of step on the flank, rms",
                                        sync_spread(run, false).median,
                                        sync_spread(run, true).median}};
  const std::vector<HelicalMeasure> measures = helical_measures(run);
  for (const HelicalMeasure& before : measures) {
    if (before.after) continue;
    for (const HelicalMeasure& after : measures) {
      const bool same = after.after && std::string_view(after.name) == before.name &&
                        std::string_view(after.side) == before.side;
      if (!same) continue;
      lines.push_back({fmt::format("{} {}", before.name, before.side), before.found.median,
                       after.found.median, std::nullopt, grade_word(run, before),
                       grade_word(run, after)});
    }
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
                                     1e6 * run.options.truth.resolution_c_rad),
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
  parts.details = {measure_table(result),    lag_charts(result),        slot_chart(result),
                   spectrum_along_z(result), spectrum_around_c(result), stroke_table_chart(result),
                   slot_table_chart(result), truth_table(result)};
  parts.ticks = run.ticks;
  parts.provenance = host::provenance(run, origins(result));
  return host::report_document(std::move(parts));
}

}  // namespace volcomp::internal_helical
