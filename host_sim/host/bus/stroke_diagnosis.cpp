#include "host_sim/host/bus/stroke_diagnosis.hpp"

#include <cstring>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/strokes/stroke_offsets.hpp"
#include "host_sim/host/bus/diagnosis.hpp"

namespace volcomp::host {
namespace {

namespace stroke = node::object::stroke;
using canopen::ObjectId;

constexpr std::array<const char*, node::kStrokeTables> kTableNames{"forward", "backward", "slots"};

template <class Real>
double read_real(NodeClient& client, ObjectId object, const std::string& what) {
  const SdoChannel::Bytes bytes = client.read(object, sizeof(Real), what);
  Real value = 0;
  std::memcpy(&value, bytes.data(), std::min(bytes.size(), sizeof value));
  return static_cast<double>(value);
}

LearnedTableDiagnosis diagnose_table(NodeClient& client, std::size_t table) {
  const auto index = static_cast<std::uint16_t>(0x2521U + table);
  LearnedTableDiagnosis d;
  d.action = client.read_value<GuardAction>({index, 1}, "learning: action");
  d.result = client.read_value<LearningResult>({index, 2}, "learning: result");
  d.updated = client.read_value<std::uint16_t>({index, 3}, "learning: nodes changed");
  d.clamped = client.read_value<std::uint16_t>({index, 4}, "learning: nodes at the limit");
  d.skipped = client.read_value<std::uint16_t>({index, 5}, "learning: nodes left alone");
  d.flank_rms_um = read_real<double>(client, {index, 6}, "learning: RMS on the flank");
  d.weight = read_real<double>(client, {index, 7}, "learning: weight");
  return d;
}

void read_watched(NodeClient& client, StrokeDiagnosis& d) {
  for (std::size_t use = 0; use < kFrameUses; ++use)
    d.frames[use] = client.read(stroke::frames[use]);
  d.passes_lost = client.read(stroke::passes_lost);
  d.discarded = client.read(stroke::discarded);
  for (std::size_t side = 0; side < 2; ++side) {
    const auto figures = static_cast<std::uint16_t>(0x2512U + side);
    d.passes[side] = client.read(stroke::passes[side]);
    d.sync_rms_um[side] = read_real<double>(client, {figures, node::kFigures}, "RMS on the flank");
    d.x_rms_um[side] = read_real<double>(client, {figures, 3 * node::kFigures}, "RMS of X");
  }
}

void read_learned(NodeClient& client, StrokeDiagnosis& d) {
  d.learning = client.read<Reason>(stroke::learn_reason);
  for (std::size_t i = 0; i < 3; ++i)
    d.prediction_um.at(i) =
        read_real<float>(client, stroke::prediction_um[i].id(), "predicted effect");
  d.tables = client.read<node::StrokeTableState>(stroke::table_state);
  const std::int32_t feed = client.read(stroke::table_feed);
  d.table_feed_mm_per_s = feed / kNmPerMm;
  d.offset_status = client.read(stroke::offset_status);
  const std::int32_t offset = client.read(stroke::offset);
  d.offset_urad = 1e6 * 256.0 / kUnitsPerRad * offset;
  for (std::size_t table = 0; table < d.table.size(); ++table)
    d.table[table] = diagnose_table(client, table);
}

const char* words(node::StrokeTableState state) {
  switch (state) {
    case node::StrokeTableState::none:
      return "none in force";
    case node::StrokeTableState::waiting:
      return "wait for the end of a stroke";
    case node::StrokeTableState::in_force:
      return "in force";
  }
  return "unknown";
}

std::string words(const LearnedTableDiagnosis& t) {
  if (t.weight <= 0.0) return "no step yet";
  if (t.action == GuardAction::roll_back)
    return fmt::format("got worse ({:.2f} µm), the best table again, weight {:g}", t.flank_rms_um,
                       t.weight);
  switch (t.result) {
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
      t.action == GuardAction::hold ? "; worse than before" : "");
}

std::string offset_words(const StrokeDiagnosis& d) {
  const bool other_feed = (d.offset_status & kOtherFeed) != 0;
  if (other_feed)
    return fmt::format("none: the tables are for F={:g} mm/s, another feed is programmed",
                       d.table_feed_mm_per_s);
  return fmt::format("{:.2f} µrad, {}", d.offset_urad, describe_status(d.offset_status));
}

}  // namespace

std::optional<StrokeDiagnosis> diagnose_strokes(NodeClient& client) {
  StrokeDiagnosis d;
  try {
    d.on = client.read(stroke::command) != 0;
  } catch (const NodeRefused& refused) {
    if (refused.code == canopen::AbortCode::no_object) return std::nullopt;
    throw;
  }
  if (!d.on) return d;
  read_watched(client, d);
  read_learned(client, d);
  return d;
}

std::string describe(const StrokeDiagnosis& d) {
  if (!d.on) return {};
  std::uint32_t unused = 0;
  for (std::size_t use = 1; use < d.frames.size(); ++use)
    unused += d.frames[use];
  std::string text = fmt::format("strokes: {} samples used, {} not; {} passes discarded, {} lost\n",
                                 d.frames[0], unused, d.discarded, d.passes_lost);
  constexpr std::array<const char*, 2> kWays{"forward", "backward"};
  for (std::size_t side = 0; side < 2; ++side)
    text +=
        fmt::format("  {}: {} passes since the last step, {:.2f} µm rms out of step, X {:.2f} µm\n",
                    kWays[side], d.passes[side], d.sync_rms_um[side], d.x_rms_um[side]);
  if (d.learning != Reason::ok)
    text +=
        fmt::format("  last refusal to learn: {} [{}]\n", sentence(d.learning), code(d.learning));
  if (d.learning == Reason::breaks_helix)
    text +=
        fmt::format("  on the flank: Z alone {:.1f} µm, C alone {:.1f} µm, together {:.1f} µm\n",
                    d.prediction_um[0], d.prediction_um[1], d.prediction_um[2]);
  text += fmt::format("  learned tables: {}\n  learned offset of C: {}\n", words(d.tables),
                      offset_words(d));
  for (std::size_t table = 0; table < d.table.size(); ++table)
    text += fmt::format("  table {}: {}\n", kTableNames[table], words(d.table[table]));
  return text;
}

nlohmann::json to_json(const StrokeDiagnosis& d) {
  nlohmann::json tables;
  for (std::size_t table = 0; table < d.table.size(); ++table) {
    const LearnedTableDiagnosis& t = d.table[table];
    tables[kTableNames[table]] = {
        {"text", words(t)},     {"updated", t.updated},           {"clamped", t.clamped},
        {"skipped", t.skipped}, {"flank_rms_um", t.flank_rms_um}, {"weight", t.weight}};
  }
  return {{"on", d.on},
          {"samples", d.frames},
          {"passes", d.passes},
          {"passes_discarded", d.discarded},
          {"passes_lost", d.passes_lost},
          {"sync_rms_um", d.sync_rms_um},
          {"x_rms_um", d.x_rms_um},
          {"refusal", d.learning == Reason::ok ? "" : code(d.learning)},
          {"prediction_um", d.prediction_um},
          {"tables", words(d.tables)},
          {"table_feed_mm_per_s", d.table_feed_mm_per_s},
          {"offset_urad", d.offset_urad},
          {"offset_text", offset_words(d)},
          {"table", tables}};
}

}  // namespace volcomp::host
