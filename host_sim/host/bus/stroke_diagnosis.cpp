#include "host_sim/host/bus/stroke_diagnosis.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/strokes/learning_guard.hpp"
#include "comp/strokes/stroke_offsets.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/bus/explain/catalogue.hpp"
#include "host_sim/host/report/json_format.hpp"

namespace volcomp::host {
namespace {

namespace lines = canopen::object_lines;
namespace stroke = node::object::stroke;
using nlohmann::json;

constexpr std::array<const char*, 2> kWays{"forward", "backward"};
constexpr std::array<const char*, node::kStrokeTables> kTableNames{"forward", "backward", "slots"};
// By StrokeTableState.
constexpr std::array kTableStates{"none in force", "wait for the end of a stroke", "in force"};

constexpr std::size_t kSyncRms = node::kFigures - 1;  // of 2512h, 2513h
constexpr std::size_t kRmsOfX = 3 * node::kFigures - 1;

node::StrokeObjects read_strokes(NodeClient& client) {
  node::StrokeObjects o;
  o.command = client.read(stroke::command);
  client.read(stroke::frames, o.frames);
  o.passes_lost = client.read(stroke::passes_lost);
  o.discarded = client.read(stroke::discarded);
  client.read(stroke::passes, o.passes);
  for (const std::size_t figure : {kSyncRms, kRmsOfX}) {
    o.figures[0].at(figure) = client.read(stroke::figures_0[figure]);
    o.figures[1].at(figure) = client.read(stroke::figures_1[figure]);
  }
  o.learn_reason = client.read(stroke::learn_reason);
  client.read(stroke::prediction_um, o.prediction_um);
  o.table_state = client.read(stroke::table_state);
  o.table_feed = client.read(stroke::table_feed);
  o.offset_status = client.read(stroke::offset_status);
  o.offset = client.read(stroke::offset);
#define LEARNED(index, sub, type, table, member, name) \
  o.learned[table].member = client.read(lines::Handle<lines::type>(index, sub, 1, name));
#include "firmware/node/objects.def"
  return o;
}

std::string words(const node::LearnedTable& t) {
  if (t.weight <= 0.0) return "no step yet";
  const auto action = static_cast<GuardAction>(t.action);
  if (action == GuardAction::roll_back)
    return fmt::format("got worse ({:.2f} µm), the best table again, weight {:g}", t.flank_rms_um,
                       t.weight);
  switch (static_cast<LearningResult>(t.result)) {
    case LearningResult::nodata:
      return "nothing was seen, unchanged";
    case LearningResult::nonfinite:
      return "a sum is not a number, unchanged";
    case LearningResult::slope:
      return "would have been too steep, unchanged";
    case LearningResult::ok:
      break;
  }
  return fmt::format(
      "{:.2f} µm on the flank, then {} nodes changed, {} left alone, {} at the limit{}",
      t.flank_rms_um, t.updated, t.skipped, t.clamped,
      action == GuardAction::hold ? "; worse than before" : "");
}

std::string offset_words(double offset_urad, std::uint16_t status, double feed_mm_per_s) {
  if ((status & kOtherFeed) != 0)
    return fmt::format("none: the tables are for F={:g} mm/s, another feed is programmed",
                       feed_mm_per_s);
  return fmt::format("{:.2f} µrad, {}", offset_urad, describe_status(status));
}

}  // namespace

json diagnose_strokes(NodeClient& client) {
  const auto command = client.find(stroke::command);
  if (!command) return nullptr;
  return stroke_facts(*command == 0 ? node::StrokeObjects{} : read_strokes(client));
}

json stroke_facts(const node::StrokeObjects& o) {
  json tables;
  for (std::size_t table = 0; table < o.learned.size(); ++table) {
    const node::LearnedTable& t = o.learned[table];
    tables[kTableNames[table]] = {
        {"text", words(t)},     {"updated", t.updated},           {"clamped", t.clamped},
        {"skipped", t.skipped}, {"flank_rms_um", t.flank_rms_um}, {"weight", t.weight}};
  }
  const double feed_mm_per_s = o.table_feed / kNmPerMm;
  const double offset_urad = 1e6 * 256.0 / kUnitsPerRad * o.offset;
  const auto refusal = static_cast<Reason>(o.learn_reason);
  return {{"on", o.command != 0},
          {"samples", o.frames},
          {"passes", o.passes},
          {"passes_discarded", o.discarded},
          {"passes_lost", o.passes_lost},
          {"sync_rms_um", {o.figures[0][kSyncRms], o.figures[1][kSyncRms]}},
          {"x_rms_um", {o.figures[0][kRmsOfX], o.figures[1][kRmsOfX]}},
          {"refusal", refusal == Reason::ok ? "" : code(refusal)},
          {"prediction_um", o.prediction_um},
          {"tables", word_of(kTableStates, o.table_state)},
          {"table_feed_mm_per_s", feed_mm_per_s},
          {"offset_urad", offset_urad},
          {"offset_text", offset_words(offset_urad, o.offset_status, feed_mm_per_s)},
          {"table", tables}};
}

std::string describe_strokes(const json& d) {
  if (!d["on"]) return {};
  std::uint64_t unused = 0;
  for (std::size_t use = 1; use < d["samples"].size(); ++use)
    unused += d["samples"][use].get<std::uint64_t>();
  std::string text = fmt::format("strokes: {} samples used, {} not; {} passes discarded, {} lost\n",
                                 d["samples"][0], unused, d["passes_discarded"], d["passes_lost"]);
  for (std::size_t side = 0; side < kWays.size(); ++side)
    text +=
        fmt::format("  {}: {} passes since the last step, {:.2f} µm rms out of step, X {:.2f} µm\n",
                    kWays[side], d["passes"][side], d["sync_rms_um"][side], d["x_rms_um"][side]);
  if (const std::string refusal = d["refusal"]; !refusal.empty())
    text += fmt::format("  last refusal to learn: {} [{}]\n",
                        meaning_of(refusal).codes.front().what, refusal);
  if (d["refusal"] == code(Reason::breaks_helix))
    text +=
        fmt::format("  on the flank: Z alone {:.1f} µm, C alone {:.1f} µm, together {:.1f} µm\n",
                    d["prediction_um"][0], d["prediction_um"][1], d["prediction_um"][2]);
  text += fmt::format("  learned tables: {}\n  learned offset of C: {}\n", d["tables"],
                      d["offset_text"]);
  for (const char* const table : kTableNames)
    text += fmt::format("  table {}: {}\n", table, d["table"][table]["text"]);
  return text;
}

}  // namespace volcomp::host
