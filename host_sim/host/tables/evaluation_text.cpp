#include "host_sim/host/tables/evaluation_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/rounded.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/report/charts.hpp"

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

double shown_place(const MachineChain& chain, std::size_t a, double q) {
  return is_rotary_axis(chain, a) ? kDegPerRad * q : q;
}

// um or urad.
double shown_offset(const MachineChain& chain, std::size_t a, double offset) {
  return offset * (is_rotary_axis(chain, a) ? kUradPerRad : kUmPerMm);
}

const char* offset_unit(const MachineChain& chain, std::size_t a) {
  return is_rotary_axis(chain, a) ? "urad" : "um";
}

// Without the sign of a rounded zero.
double six_decimals(double value) { return rounded(value, 6); }
double three_decimals(double value) { return rounded(value, 3); }

std::string letters_beyond(const MachineChain& chain, const EvaluatedPoint& point) {
  std::string letters;
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    if ((point.beyond >> a & 1U) != 0) letters += chain.axis(a).letter;
  return letters;
}

std::string source_text(const TableSource& source) {
  const std::string crc =
      source.crc ? fmt::format(", CRC-32 {:08X}", *source.crc) : ", built for this evaluation";
  return fmt::format("{}{}", fmt::join(source.files, " "), crc);
}

// "X mean, Y mean, Z mean".
std::string directions_text(const TableEvaluator& evaluator) {
  std::vector<std::string> axes;
  for (std::size_t a = 0; a < evaluator.chain().axis_count(); ++a)
    axes.push_back(
        fmt::format("{} {}", evaluator.chain().axis(a).letter, travel_name(evaluator.travel())));
  return fmt::format("{}", fmt::join(axes, ", "));
}

std::string heading(const TableEvaluator& evaluator, const TableSource& source) {
  return fmt::format("tables: {}\nchain {}; direction of travel: {}\n", source_text(source),
                     chain_text(evaluator.chain()), directions_text(evaluator));
}

std::string distance_text(const OffsetDistance& d, const MachineChain& chain) {
  std::string text = fmt::format("{:.2f} nm", d.nm);
  if (chain.has_rotary()) text += fmt::format(" and {:.2f} nrad", d.nrad);
  return text;
}

std::string agreement_text(const TableEvaluator& evaluator, const Evaluation& evaluation) {
  const MachineChain& chain = evaluator.chain();
  const std::string model = fmt::format("run-time model within {} of the exact chain\n",
                                        distance_text(evaluation.model_from_exact, chain));
  if (!evaluator.within_1nm()) return "tick not evaluated: more than 5 axes or 128 knots\n" + model;
  return fmt::format("tick within {} of its model in double, {}\n",
                     distance_text(evaluation.tick_from_model, chain),
                     *evaluator.within_1nm() ? "1 nm is promised"
                                             : "1 nm is not promised for errors above 1 mm") +
         model;
}

std::string offsets_line(const TableEvaluator& evaluator, const Pose& offset, const char* what) {
  std::string line = "  offset";
  for (const std::size_t a : evaluator.offset_axes())
    line += fmt::format("  {} {:.3f} {}", evaluator.chain().axis(a).letter,
                        three_decimals(shown_offset(evaluator.chain(), a, offset[a])),
                        is_rotary_axis(evaluator.chain(), a) ? "µrad" : "µm");
  return line + fmt::format(", {}\n", what);
}

std::string point_lines(const TableEvaluator& evaluator, const EvaluatedPoint& point) {
  const MachineChain& chain = evaluator.chain();
  std::string text = "at";
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    text += fmt::format("  {} {:.6g} {}", chain.axis(a).letter, shown_place(chain, a, point.at[a]),
                        is_rotary_axis(chain, a) ? "deg" : "mm");
  if (point.beyond != 0)
    text += fmt::format(", {} beyond the table: the values are those of its end",
                        letters_beyond(chain, point));
  const Vec3 e = (kUmPerMm * point.position).unaryExpr(&three_decimals);
  const Vec3 w = (kUradPerRad * point.orientation).unaryExpr(&three_decimals);
  text += fmt::format(
      "\n  E  {:.3f} {:.3f} {:.3f} µm, orientation {:.3f} {:.3f} {:.3f} µrad, in base\n", e(0),
      e(1), e(2), w(0), w(1), w(2));
  if (!point.authority) return text + "  no offset: the correcting axes cannot act here\n";
  text += offsets_line(evaluator, point.exact, "exact chain");
  if (point.tick) text += offsets_line(evaluator, *point.tick, "tick");
  return text;
}

std::string largest_lines(const TableEvaluator& evaluator, const Evaluation& evaluation) {
  const auto longest =
      std::max_element(evaluation.points.begin(), evaluation.points.end(),
                       [](const EvaluatedPoint& a, const EvaluatedPoint& b) {
                         return a.position.squaredNorm() < b.position.squaredNorm();
                       });
  const auto refused = std::count_if(evaluation.points.begin(), evaluation.points.end(),
                                     [](const EvaluatedPoint& p) { return !p.authority; });
  std::string text = fmt::format("{} points, the largest error:\n", evaluation.points.size());
  text += point_lines(evaluator, *longest);
  if (refused != 0)
    text += fmt::format("{} points where the correcting axes cannot act\n", refused);
  return text;
}

void add_offset_cells(const TableEvaluator& evaluator, const EvaluatedPoint& point,
                      std::string& row) {
  const auto add = [&](std::size_t a, const Pose* offset) {
    row += ',';
    if (offset != nullptr)
      row += fmt::format("{:.6f}", six_decimals(shown_offset(evaluator.chain(), a, (*offset)[a])));
  };
  for (const std::size_t a : evaluator.offset_axes()) {
    add(a, point.authority ? &point.exact : nullptr);
    add(a, point.authority ? &point.model : nullptr);
    add(a, point.tick ? &*point.tick : nullptr);
  }
}

std::string csv_header(const TableEvaluator& evaluator) {
  const MachineChain& chain = evaluator.chain();
  std::string header;
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    header +=
        fmt::format("{} [{}],", chain.axis(a).letter, is_rotary_axis(chain, a) ? "deg" : "mm");
  header += "EX [um],EY [um],EZ [um],EA [urad],EB [urad],EC [urad]";
  for (const std::size_t a : evaluator.offset_axes())
    for (const char* of : {"exact", "model", "tick"})
      header += fmt::format(",{} {} [{}]", chain.axis(a).letter, of, offset_unit(chain, a));
  return header + ",beyond\n";
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

std::string evaluation_text(const TableEvaluator& evaluator, const Evaluation& evaluation,
                            const TableSource& source) {
  std::string text = heading(evaluator, source);
  if (evaluation.points.size() > kMostShownPoints) {
    text += largest_lines(evaluator, evaluation);
  } else {
    for (const EvaluatedPoint& point : evaluation.points)
      text += point_lines(evaluator, point);
  }
  return text + agreement_text(evaluator, evaluation);
}

std::string evaluation_csv(const TableEvaluator& evaluator, const Evaluation& evaluation,
                           const TableSource& source) {
  const MachineChain& chain = evaluator.chain();
  std::string text = fmt::format(
      "# tables: {}\n# chain {}; direction of travel: {}\n# E: error of the tool point and "
      "orientation in base, exact chain; offsets: exact chain, run-time model in double, tick\n{}",
      source_text(source), chain_text(chain), directions_text(evaluator), csv_header(evaluator));
  for (const EvaluatedPoint& point : evaluation.points) {
    std::string row;
    for (std::size_t a = 0; a < chain.axis_count(); ++a)
      row += fmt::format("{:.9g},", shown_place(chain, a, point.at[a]));
    std::vector<std::string> error;
    for (Eigen::Index i = 0; i < 3; ++i)
      error.push_back(fmt::format("{:.6f}", six_decimals(kUmPerMm * point.position(i))));
    for (Eigen::Index i = 0; i < 3; ++i)
      error.push_back(fmt::format("{:.6f}", six_decimals(kUradPerRad * point.orientation(i))));
    row += fmt::format("{}", fmt::join(error, ","));
    add_offset_cells(evaluator, point, row);
    text += row + ',' + letters_beyond(chain, point) + '\n';
  }
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
