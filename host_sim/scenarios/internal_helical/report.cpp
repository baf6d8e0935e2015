#include "host_sim/scenarios/internal_helical/report.hpp"

#include <fmt/format.h>

#include "host_sim/scenarios/internal_helical/charts.hpp"
#include "host_sim/scenarios/internal_helical/figures.hpp"
#include "host_sim/scenarios/report_parts.hpp"
#include "host_sim/version.hpp"

namespace volcomp::sim {
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
          {"title", "The gear before and after"},
          {"columns",
           {{{"title", "deviation"}},
            {{"title", ""}},
            column("median", "µm", 1),
            column("lowest", "µm", 1),
            column("highest", "µm", 1),
            {{"title", "allowed for the median, µm"}},
            {{"title", "within"}},
            column("grade 1995", "", 0),
            column("grade 2013", "", 0),
            column("paper", "µm", 1)}},
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
            column("amount", "", 1),
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

json provenance(const InternalHelicalResult& run, const std::string& command,
                const std::string& transport) {
  return json::array({{"data", "simulated: no machine and no gear was measured"},
                      {"command", command},
                      {"version", kVersion},
                      {"learned", kLearningWays.at(static_cast<std::size_t>(run.options.way))},
                      {"seeds", fmt::format("1 to {}; curves are of seed 1", run.options.seeds)},
                      {"transport", transport}});
}

}  // namespace

json internal_helical_document(const InternalHelicalResult& run, const std::string& command,
                               const std::string& transport) {
  const Verdict verdict = internal_helical_verdict(run);
  json sections =
      json::array({measure_table(run), tracking_charts(run), learning_chart(run), lag_charts(run),
                   slot_chart(run), spectrum_along_z(run), spectrum_around_c(run),
                   stroke_table_chart(run), slot_table_chart(run), cumulative_pitch_charts(run)});
  for (std::size_t side = 0; side < kHelicalSides.size(); ++side)
    sections.push_back(single_pitch_chart(run, side));
  sections.push_back(profile_charts(run));
  sections.push_back(truth_table(run));
  return {{"title", "Internal helical gear: grinding watched and compensated"},
          {"subtitle",
           fmt::format("{} teeth, module {:g}, helix {:g}°, width {:g} mm; offsets of C learned in "
                       "{} updates",
                       run.gear.teeth, run.gear.module, run.gear.helix_angle / kRadPerDegree,
                       run.job.width_mm, run.options.updates)},
          {"verdict", {{"ok", verdict.ok}, {"text", verdict.text}}},
          {"provenance", provenance(run, command, transport)},
          {"sections", sections}};
}

}  // namespace volcomp::sim
