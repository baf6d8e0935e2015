#include "host_sim/host/measure/strokes/stroke_learning_report.hpp"

#include <fmt/format.h>

#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 3> kTables{
    "C along the stroke, Z upwards", "C along the stroke, Z downwards", "C from slot to slot"};

std::string passes_in_words(const StrokesLearned& l) {
  return fmt::format(
      "{} cycles of {:g} ms, {} passes upwards, {} downwards, {} discarded; "
      "{:.2f} mm/s",
      l.cycles, 1e3 * l.period_s, l.passes[0], l.passes[1], l.discarded.size(), l.feed_mm_per_s);
}

// How far the axes are off their commands, in their unit and on the flank.
json errors_table(const StrokesLearned& l) {
  const InternalGear& gear = l.machine.grinding->gear;
  const double per_mm = kUmPerMm * gear.normal_lever() * std::abs(gear.turn_per_mm);
  const double per_rad = kUmPerMm * gear.normal_lever();
  json rows = json::array();
  rows.push_back(json::array(
      {"Z", fmt::format("{:.2f} µm", kUmPerMm * l.z.peak), per_mm * l.z.peak, per_mm * l.z.rms}));
  rows.push_back(json::array({"C", fmt::format("{:.2f} µrad", kUradPerRad * l.c.peak),
                              per_rad * l.c.peak, per_rad * l.c.rms}));
  rows.push_back(
      json::array({"Z and C out of step", "", l.out_of_step_um.peak, l.out_of_step_um.rms}));
  if (l.has_x)
    rows.push_back(
        json::array({"X", fmt::format("{:.2f} µm", kUmPerMm * l.x.peak), nullptr, nullptr}));
  json table = table_section("Errors over the face",
                             {plain_column("", "what"), plain_column("largest", "largest"),
                              column("on the flank, largest", "µm", 2, "flank_max_um"),
                              column("rms", "µm", 2, "flank_rms_um")},
                             std::move(rows));
  table["name"] = "errors";
  return with_id("errors", std::move(table),
                 "A lag that Z and C have in common moves along the helix and leaves no mark: "
                 "what counts is how far they are out of step.");
}

std::string result_in_words(const LearningReport& r) {
  switch (r.result) {
    case LearningResult::nonfinite:
      return "refused: not finite";
    case LearningResult::nodata:
      return "too few passes or samples";
    case LearningResult::slope:
      return "refused: too steep";
    case LearningResult::ok:
      break;
  }
  if (r.clamped > 0) return fmt::format("learned, {} at the limit", r.clamped);
  return r.updated > 0 ? "learned" : "nothing to learn";
}

json tables_table(const StrokesLearned& l) {
  json rows = json::array();
  for (std::size_t k = 0; k < l.step.size(); ++k) {
    const TableStep& s = l.step.at(k);
    rows.push_back(json::array({kTables.at(k), result_in_words(s.report), s.report.updated,
                                s.before_um, s.after_um, kUradPerRad * s.peak_rad}));
  }
  json table = table_section(
      "Offsets of C",
      {plain_column("table", "table"), plain_column("result", "result"),
       plain_column("places", "places"), column("comes back, rms", "µm", 2, "before_um"),
       column("then left", "µm", 2, "after_um"), column("largest offset", "µrad", 2, "peak_urad")},
      std::move(rows));
  table["name"] = "tables";
  return with_id("tables", std::move(table),
                 "Comes back: the mean of all passes by place, on the flank. Then left: if it "
                 "comes back alike with the new offsets.");
}

Verdict verdict_of(const StrokesLearned& l) {
  return {l.good(),
          l.good() ? "offsets were learned" : "nothing was learned, or a step was refused"};
}

json offsets_chart(const StrokesLearned& l) {
  const LearnedTables& t = l.tables;
  std::vector<double> z;
  for (std::size_t j = 0; j < t.stroke[0].size(); ++j)
    z.push_back(t.z0_mm + t.pitch_mm * static_cast<double>(j));
  json series = json::array({series_of("Z upwards", z, scaled(t.stroke[0], kUradPerRad)),
                             series_of("Z downwards", z, scaled(t.stroke[1], kUradPerRad))});
  return lines_chart("stroke", "Offset of C along the stroke", axis_label("Z", "mm"),
                     axis_label("offset of C", "µrad"), std::move(series));
}

json slots_chart(const StrokesLearned& l) {
  return bar_chart("slots", "Offset of C by slot", counted(l.tables.slot.size()),
                   axis_label("offset of C", "µrad"),
                   json::array({bars_of("slot", scaled(l.tables.slot, kUradPerRad))}),
                   "Counted from 1; " + l.slot_0 + ".");
}

}  // namespace

std::string learned_text(const StrokesLearned& l) {
  std::vector<std::string> first{l.log + ": " + passes_in_words(l), l.slot_0};
  return text_of({{"sections", json::array({text_section("", first), errors_table(l),
                                            tables_table(l), text_section("", l.discarded)})}});
}

json learned_json(const StrokesLearned& l) {
  const LearnedTables& t = l.tables;
  return {{"version", kVersion},
          {"log", l.log},
          {"machine", l.machine.name},
          {"cycles", l.cycles},
          {"period_s", l.period_s},
          {"feed_mm_per_s", l.feed_mm_per_s},
          {"passes", {{"upwards", l.passes[0]}, {"downwards", l.passes[1]}}},
          {"discarded", l.discarded},
          {"slot_0", l.slot_0},
          {"errors", figures_of_table(errors_table(l))},
          {"tables", figures_of_table(tables_table(l))},
          {"learned",
           {{"z0_mm", t.z0_mm},
            {"pitch_mm", t.pitch_mm},
            {"upwards_rad", t.stroke[0]},
            {"downwards_rad", t.stroke[1]},
            {"slots_rad", t.slot}}},
          {"good", l.good()}};
}

json learned_document(const StrokesLearned& l, const RunContext& run, Origins origins) {
  origins.data = "measured: what the log holds";
  origins.warnings = l.discarded;
  ReportParts parts;
  parts.title = "Learned from strokes";
  parts.subtitle = l.machine.name + ": " + passes_in_words(l);
  parts.verdict = verdict_of(l);
  parts.before_after = tables_table(l);
  parts.plots = json::array({offsets_chart(l), slots_chart(l)});
  parts.details = json::array({errors_table(l)});
  parts.provenance = provenance(run, origins);
  return report_document(std::move(parts));
}

}  // namespace volcomp::host
