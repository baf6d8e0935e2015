#include "host_sim/scenarios/face_gear/report.hpp"

#include <fmt/format.h>

#include "comp/evaluation/face_gear_grade.hpp"
#include "comp/units.hpp"
#include "host_sim/scenarios/face_gear/figures.hpp"
#include "host_sim/scenarios/face_gear/flank_charts.hpp"
#include "host_sim/scenarios/report_parts.hpp"
#include "host_sim/version.hpp"

namespace volcomp::sim {
namespace {

using nlohmann::json;

json stage_table(const FaceGearResult& run) {
  json rows = json::array();
  for (std::size_t s = 0; s < kFaceStages.size(); ++s) {
    const FaceInspection& i = run.inspection.at(s);
    rows.push_back({kFaceStages.at(s), run.map_error.at(s).rms, run.map_error.at(s).max,
                    i.pitch[0].figures.total, i.pitch[0].figures.single, i.pitch[1].figures.total,
                    i.pitch[1].figures.single, grade_text(i)});
  }
  rows.push_back({"the gear itself", nullptr, nullptr, run.true_pitch[0].figures.total,
                  run.true_pitch[0].figures.single, run.true_pitch[1].figures.total,
                  run.true_pitch[1].figures.single, ""});
  return {{"type", "table"},
          {"id", "stages"},
          {"title", "Before and after: frame and volumetric compensation"},
          {"columns",
           {{{"title", "measured with"}},
            column("map − gear, rms", "µm", 2),
            column("largest", "µm", 2),
            column("F_p left", "µm", 1),
            column("f_pt left", "µm", 1),
            column("F_p right", "µm", 1),
            column("f_pt right", "µm", 1),
            {{"title", "profile, rows 2 to 6"}}}},
          {"rows", rows},
          {"note", fmt::format("Grades: {}.", kFaceGearLimitsSource)}};
}

json statement_table() {
  json rows = json::array();
  for (const PaperStatement& s : paper_statements())
    rows.push_back({s.what, s.stated, s.found});
  return {{"type", "table"},
          {"id", "paper"},
          {"title", "What the paper says of its Tables 5 to 8"},
          {"columns",
           {{{"title", "largest difference between machine and measuring centre"}},
            column("stated", "µm", 1),
            column("in the tables", "µm", 1)}},
          {"rows", rows},
          {"note",
           "The profile is the largest range of a column over rows 2 to 6; with all seven "
           "rows the same column has 8.0 µm."}};
}

// The paper gives nothing of it.
json machine_table(const FaceGearResult& run) {
  json rows = json::array();
  for (const AxisFile& axis : run.machine.axes) {
    const double scale = axis.rotary ? 180.0 / kPi : 1.0;
    rows.push_back(
        {std::string(1, axis.letter), scale * axis.lo, scale * axis.hi, axis.rotary ? "deg" : "mm",
         axis.rotary ? "3 µm, 10 µrad once per turn" : "3 µm, 10 µrad along the travel"});
  }
  const Vec3 off = kUmPerMm * (true_mounting().t - nominal_mounting().t);
  return {{"type", "table"},
          {"id", "machine"},
          {"title", "The machine, as chosen here"},
          {"columns",
           {{{"title", "axis"}},
            {{"title", "from"}, {"digits", 0}},
            {{"title", "to"}, {"digits", 0}},
            {{"title", "unit"}},
            {{"title", "size of its six errors"}}}},
          {"rows", rows},
          {"note",
           fmt::format("Neither chain nor strokes nor errors of the YK7280 are published: all of "
                       "it is free. The gear lies {:.1f}, {:.1f}, {:.1f} µm out of place and 1' "
                       "turned; scale of the table 1.8\", swing arm within {:g} µm.",
                       off.x(), off.y(), off.z(), kUmPerMm * kArmRepeatability_mm)}};
}

json provenance(const FaceGearResult& run, const std::string& command,
                const std::string& transport) {
  const FaceGearOptions& o = run.options;
  return json::array({{"data", "simulated: no machine and no gear was measured"},
                      {"command", command},
                      {"version", kVersion},
                      {"machine file", o.machine.filename().string()},
                      {"gear", o.gear},
                      {"form of the flanks", kFormTruths.at(static_cast<std::size_t>(o.form))},
                      {"seed", std::to_string(o.seed)},
                      {"transport", transport}});
}

}  // namespace

json face_gear_document(const FaceGearResult& run, const std::string& command,
                        const std::string& transport) {
  const Verdict verdict = face_gear_verdict(run);
  json sections = json::array();
  sections.push_back(topography(run, FaceStage::compensated));
  for (json& map : flank_maps(run, FaceStage::compensated))
    sections.push_back(std::move(map));
  sections.push_back(stage_table(run));
  sections.push_back(pitch_curves(run));
  for (std::size_t side = 0; side < kFaceSides.size(); ++side)
    sections.push_back(single_pitch_bars(run, side));
  sections.push_back(statement_table());
  sections.push_back(machine_table(run));
  return {{"title", "YK7280: a face gear measured on its machine"},
          {"subtitle",
           fmt::format("{} teeth, module {:g}, shaper of {} teeth; every touch through drives, bus "
                       "and node",
                       run.gear.teeth, run.gear.module, run.gear.shaper_teeth)},
          {"verdict", {{"ok", verdict.ok}, {"text", verdict.text}}},
          {"provenance", provenance(run, command, transport)},
          {"sections", sections}};
}

}  // namespace volcomp::sim
