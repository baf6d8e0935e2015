#include "host_sim/host/tables/evaluation_text.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/rounded.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/json_format.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

const char* travel_name(Travel travel) {
  switch (travel) {
    case Travel::forward:
      return "up";
    case Travel::backward:
      return "down";
    case Travel::unknown:
      break;
  }
  return "mean";
}

bool is_rotary_axis(const MachineChain& chain, std::size_t a) {
  return chain.axis(a).kind == JointKind::rotary;
}

// um or urad.
double shown_offset(const MachineChain& chain, std::size_t a, double offset) {
  return offset * (is_rotary_axis(chain, a) ? kUradPerRad : kUmPerMm);
}

const char* offset_unit(const MachineChain& chain, std::size_t a) {
  return is_rotary_axis(chain, a) ? "urad" : "um";
}

// In mm or degrees, of a point of the facts.
double shown_place(const MachineChain& chain, std::size_t a, const json& point) {
  const double q = point["at"][std::string(1, chain.axis(a).letter)];
  return is_rotary_axis(chain, a) ? kDegPerRad * q : q;
}

std::string source_text(const json& facts) {
  return fmt::format("{}{}", fmt::join(facts["files"], " "),
                     facts.contains("crc32") ? fmt::format(", CRC-32 {}", facts["crc32"])
                                             : ", built for this evaluation");
}

// "X mean, Y mean, Z mean".
std::string directions_text(const json& facts) {
  std::vector<std::string> axes;
  for (const json& axis : facts["axes"])
    axes.push_back(fmt::format("{} {}", axis["axis"], axis["direction"]));
  return fmt::format("{}", fmt::join(axes, ", "));
}

std::string distance_text(const json& d, const MachineChain& chain) {
  std::string text = fmt::format("{:.2f} nm", d["nm"]);
  if (chain.has_rotary()) text += fmt::format(" and {:.2f} nrad", d["nrad"]);
  return text;
}

std::string agreement_text(const MachineChain& chain, const json& facts) {
  const std::string model = fmt::format("run-time model within {} of the exact chain\n",
                                        distance_text(facts["model_from_exact_max"], chain));
  if (!facts.contains("tick_from_model_max"))
    return "tick not evaluated: more than 5 axes or 128 knots\n" + model;
  return fmt::format("tick within {} of its model in double, {}\n",
                     distance_text(facts["tick_from_model_max"], chain),
                     facts["tick_within_1nm_promised"]
                         ? "1 nm is promised"
                         : "1 nm is not promised for errors above 1 mm") +
         model;
}

std::string offsets_line(const json& point, const TableEvaluator& evaluator, const char* of,
                         const char* what) {
  std::string line = "  offset";
  for (const std::size_t a : evaluator.offset_axes()) {
    const std::string letter(1, evaluator.chain().axis(a).letter);
    const json& offset = point["offsets"][letter];
    line += fmt::format("  {} {:.3f} {}", letter, rounded(offset[of], 3),
                        offset["unit"] == "urad" ? "µrad" : "µm");
  }
  return line + fmt::format(", {}\n", what);
}

std::string point_lines(const TableEvaluator& evaluator, const json& point) {
  const MachineChain& chain = evaluator.chain();
  std::string text = "at";
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    text += fmt::format("  {} {:.6g} {}", chain.axis(a).letter, shown_place(chain, a, point),
                        is_rotary_axis(chain, a) ? "deg" : "mm");
  if (!point["beyond_table"].empty())
    text += fmt::format(", {} beyond the table: the values are those of its end",
                        fmt::join(point["beyond_table"], ""));
  const auto three = [](const json& values) {
    return fmt::format("{:.3f} {:.3f} {:.3f}", rounded(values[0], 3), rounded(values[1], 3),
                       rounded(values[2], 3));
  };
  text += fmt::format("\n  E  {} µm, orientation {} µrad, in base\n", three(point["error_um"]),
                      three(point["orientation_urad"]));
  if (!point["authority"]) return text + "  no offset: the correcting axes cannot act here\n";
  text += offsets_line(point, evaluator, "exact", "exact chain");
  if (evaluator.within_1nm()) text += offsets_line(point, evaluator, "tick", "tick");
  return text;
}

std::string largest_lines(const TableEvaluator& evaluator, const json& points) {
  const auto squared = [](const json& point) {
    const json& e = point["error_um"];
    return Vec3(e[0], e[1], e[2]).squaredNorm();
  };
  const auto longest =
      std::max_element(points.begin(), points.end(),
                       [&](const json& a, const json& b) { return squared(a) < squared(b); });
  const auto refused = std::count_if(points.begin(), points.end(),
                                     [](const json& p) { return p["authority"] == false; });
  std::string text = fmt::format("{} points, the largest error:\n", points.size());
  text += point_lines(evaluator, *longest);
  if (refused != 0)
    text += fmt::format("{} points where the correcting axes cannot act\n", refused);
  return text;
}

constexpr std::array kOffsets{"exact", "model", "tick"};

std::string csv_header(const TableEvaluator& evaluator) {
  const MachineChain& chain = evaluator.chain();
  std::string header;
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    header +=
        fmt::format("{} [{}],", chain.axis(a).letter, is_rotary_axis(chain, a) ? "deg" : "mm");
  header += "EX [um],EY [um],EZ [um],EA [urad],EB [urad],EC [urad]";
  for (const std::size_t a : evaluator.offset_axes())
    for (const char* const of : kOffsets)
      header += fmt::format(",{} {} [{}]", chain.axis(a).letter, of, offset_unit(chain, a));
  return header + ",beyond\n";
}

std::string csv_row(const TableEvaluator& evaluator, const json& point) {
  const MachineChain& chain = evaluator.chain();
  std::string row;
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    row += fmt::format("{:.9g},", shown_place(chain, a, point));
  for (const char* const errors : {"error_um", "orientation_urad"})
    for (const json& value : point[errors])
      row += fmt::format("{:.6f},", rounded(value, 6));
  for (const std::size_t a : evaluator.offset_axes()) {
    const json offset = point["offsets"].value(std::string(1, chain.axis(a).letter), json());
    for (const char* const of : kOffsets) {
      if (!offset.is_null() && !offset[of].is_null())
        row += fmt::format("{:.6f}", rounded(offset[of], 6));
      row += ',';
    }
  }
  return row + fmt::format("{}\n", fmt::join(point["beyond_table"], ""));
}

json point_json(const TableEvaluator& evaluator, const EvaluatedPoint& point) {
  const MachineChain& chain = evaluator.chain();
  json at = json::object();
  json beyond = json::array();
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    const std::string letter(1, chain.axis(a).letter);
    at[letter] = point.at[a];
    if ((point.beyond >> a & 1U) != 0) beyond.push_back(letter);
  }
  const Vec3 e = kUmPerMm * point.position;
  const Vec3 w = kUradPerRad * point.orientation;
  json offsets = json::object();
  for (const std::size_t a : evaluator.offset_axes()) {
    if (!point.authority) break;
    json& offset = offsets[std::string(1, chain.axis(a).letter)];
    offset = {{"unit", offset_unit(chain, a)},
              {"exact", shown_offset(chain, a, point.exact[a])},
              {"model", shown_offset(chain, a, point.model[a])}};
    offset["tick"] = point.tick ? json(shown_offset(chain, a, (*point.tick)[a])) : json();
  }
  return {{"at", at},
          {"beyond_table", beyond},
          {"error_um", {e(0), e(1), e(2)}},
          {"orientation_urad", {w(0), w(1), w(2)}},
          {"authority", point.authority},
          {"offsets", offsets}};
}

json distance_json(const OffsetDistance& d) { return {{"nm", d.nm}, {"nrad", d.nrad}}; }

}  // namespace

std::string evaluation_text(const TableEvaluator& evaluator, const json& facts) {
  std::string text = fmt::format("tables: {}\nchain {}; direction of travel: {}\n",
                                 source_text(facts), facts["chain"], directions_text(facts));
  if (facts["points"].size() > kMostShownPoints) {
    text += largest_lines(evaluator, facts["points"]);
  } else {
    for (const json& point : facts["points"])
      text += point_lines(evaluator, point);
  }
  return text + agreement_text(evaluator.chain(), facts);
}

std::string evaluation_csv(const TableEvaluator& evaluator, const json& facts) {
  std::string text = fmt::format(
      "# tables: {}\n# chain {}; direction of travel: {}\n# E: error of the tool point and "
      "orientation in base, exact chain; offsets: exact chain, run-time model in double, tick\n{}",
      source_text(facts), facts["chain"], directions_text(facts), csv_header(evaluator));
  for (const json& point : facts["points"])
    text += csv_row(evaluator, point);
  return text;
}

json evaluation_json(const TableEvaluator& evaluator, const Evaluation& evaluation,
                     const TableSource& source) {
  const MachineChain& chain = evaluator.chain();
  json axes = json::array();
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    axes.push_back({{"axis", std::string(1, chain.axis(a).letter)},
                    {"unit", is_rotary_axis(chain, a) ? "rad" : "mm"},
                    {"direction", travel_name(evaluator.travel())}});
  json points = json::array();
  for (const EvaluatedPoint& point : evaluation.points)
    points.push_back(point_json(evaluator, point));
  json out{{"files", source.files},
           {"chain", chain_text(chain)},
           {"axes", axes},
           {"points", points},
           {"model_from_exact_max", distance_json(evaluation.model_from_exact)}};
  if (source.crc) out["crc32"] = fmt::format("{:08X}", *source.crc);
  if (const std::optional<bool> within = evaluator.within_1nm()) {
    out["tick_within_1nm_promised"] = *within;
    out["tick_from_model_max"] = distance_json(evaluation.tick_from_model);
  }
  return out;
}

}  // namespace volcomp::host
