#include "host_sim/host/machine/machine_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"
#include "comp/tick/compensator.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/machine/machine_bus.hpp"
#include "host_sim/host/machine/machine_facts.hpp"
#include "host_sim/host/machine/offset_facts.hpp"
#include "host_sim/host/report/json_format.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

const char* unit_of(const AxisFile& axis) { return axis.rotary ? "rad" : "mm"; }

const char* model_of(const MachineFile& m) {
  return m.chain.has_rotary() ? "second-order recursion" : "first-order sum, folded";
}

// Base to tip, for instance "base - Y - X".
std::string branch_text(const MachineFile& machine, const BodyPath& path) {
  std::string text = "base";
  for (const std::uint8_t body : path) {
    const Joint& joint = machine.chain.joint(body);
    text += joint.moves() ? fmt::format(" - {}", joint.letter)
                          : fmt::format(" - ({})", machine.body_names[body]);
  }
  return text;
}

json pose_facts(const MachineFile& m, const Pose& q) {
  json at;
  for (std::size_t a = 0; a < m.axes.size(); ++a)
    at[std::string(1, m.axes[a].letter)] = q[a];
  return at;
}

json body_facts(const MachineFile& m) {
  const MachineDescription& d = m.chain.description();
  constexpr const char* kAxes = "XYZ";
  json bodies = json::array();
  for (std::size_t k = 0; k < d.body_count; ++k) {
    const Joint& joint = d.body.at(k).joint;
    json body{{"number", k + 1}, {"name", m.body_names[k]}, {"on", d.body.at(k).lower}};
    body["joint"] = joint.kind == JointKind::fixed       ? "fixed"
                    : joint.kind == JointKind::prismatic ? "linear"
                                                         : "rotary";
    if (joint.moves()) {
      body["axis"] = std::string(1, joint.letter);
      body["direction"] = std::string(1, kAxes[index(joint.axis)]);
      body["sign"] = joint.sign;
    }
    body["offset_mm"] = joint.offset;
    body["side"] = joint.branch == Branch::work   ? "workpiece"
                   : joint.branch == Branch::tool ? "tool"
                                                  : "bed";
    bodies.push_back(body);
  }
  return bodies;
}

// Units of the drive in one mm or turn, as written in a machine file.
double units_of_drive(const AxisFile& axis) {
  if (axis.rotary) return units_per_turn(axis.drive);
  return kNmPerMm * axis.drive.scale_denominator / axis.drive.scale_numerator;
}

json axis_facts(const MachineFile& m) {
  json axes = json::array();
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    const AxisFile& axis = m.axes[a];
    json one{{"name", std::string(1, axis.letter)},
             {"kind", axis.rotary ? "rotary" : "linear"},
             {"unit", unit_of(axis)},
             {"travel", {axis.lo, axis.hi}},
             {"reference", axis.reference},
             {"targets", axis.targets},
             {"node_id", axis.drive.node},
             {axis.rotary ? "units_per_turn" : "units_per_mm", units_of_drive(axis)},
             {"scale", {axis.drive.scale_numerator, axis.drive.scale_denominator}},
             {"error_motions", motion_errors(axis.letter)},
             {"location_errors", location_errors(m.chain.axis(a))}};
    if (axis.drive.units_per_turn != 0) one["scale"] = nullptr;  // a turn, no fraction
    if (axis.drive.referenced_mask) one["referenced_mask"] = *axis.drive.referenced_mask;
    if (axis.drive.reports_offset == false) one["reports_offset"] = false;
    if (!axis.drive.model.empty()) one["drive"] = axis.drive.model;
    if (!axis.drive.model.empty() || axis.drive.way != Way::offset)
      one["way"] = word_of_way(axis.drive.way);
    if (axis.drive.software_limits_mm) one["software_limits_mm"] = *axis.drive.software_limits_mm;
    axes.push_back(one);
  }
  return axes;
}

json authority_facts(const MachineFile& m) {
  const LeastAuthority least = least_authority(m);
  json letters = json::array();
  const MachineDescription& d = m.chain.description();
  for (std::size_t c = 0; c < d.correcting_count; ++c)
    letters.push_back(std::string(1, m.axes[d.correcting[c]].letter));
  return {{"axes", letters},
          {"least_authority", least.value},
          {"at", pose_facts(m, least.at)},
          {"enough", least.value >= kMinAuthority}};
}

json letters_of(const MachineFile& m, const std::vector<std::size_t>& axes) {
  json letters = json::array();
  for (const std::size_t a : axes)
    letters.push_back(std::string(1, m.axes[a].letter));
  return letters;
}

// What the axes that orient can do, or what all could that turn.
json orientation_facts(const MachineFile& m) {
  const std::vector<std::size_t> orienting = orienting_axes(m.chain);
  const std::vector<std::size_t> rotary = rotary_axes(m.chain);
  json facts{{"axes", letters_of(m, orienting)},
             {"corrected", !orienting.empty()},
             {"rotary_axes", letters_of(m, rotary)}};
  if (rotary.empty()) return facts;
  const LeastAuthority least = least_turning(m, orienting.empty() ? rotary : orienting);
  facts["least_turning"] = least.value;
  facts["at"] = pose_facts(m, least.at);
  return facts;
}

json lower_bodies(const MachineFile& m) {
  const MachineDescription& d = m.chain.description();
  json lower = json::array();
  for (std::size_t k = 0; k < d.body_count; ++k)
    lower.push_back(d.body.at(k).lower);
  return lower;
}

std::string words(const json& list) {
  std::vector<std::string> parts;
  for (const json& item : list)
    parts.push_back(item.is_string() ? item.get<std::string>() : item.dump());
  return fmt::format("{}", fmt::join(parts, " "));
}

std::string place_text(const json& at) {
  std::vector<std::string> parts;
  for (const auto& [letter, value] : at.items())
    parts.push_back(fmt::format("{} {:.4g}", letter, value));
  return fmt::format("{}", fmt::join(parts, ", "));
}

json body_table(const json& facts) {
  json columns = json::array({plain_column("body", "number")});
  for (const char* member : {"on", "side", "joint", "name", "axis", "direction", "sign"})
    columns.push_back(plain_column(member, member));
  columns.push_back(plain_column("offset [mm]", "offset_mm/0"));
  columns.push_back(plain_column("", "offset_mm/1"));
  columns.push_back(plain_column("", "offset_mm/2"));
  return fact_table("", facts["bodies"], columns);
}

std::string axes_text(const json& facts) {
  std::string text;
  for (const json& a : facts["axes"]) {
    const std::string name = a["name"];
    const std::string unit = a["unit"];
    const bool rotary = a["kind"] == "rotary";
    text += fmt::format(
        "axis {}: {:g} to {:g} {}, zero at {:g}, {} targets; drive {}, {:.15g} units per {}", name,
        a["travel"][0], a["travel"][1], unit, a["reference"], a["targets"], a["node_id"],
        a[rotary ? "units_per_turn" : "units_per_mm"], rotary ? "turn" : "mm");
    if (a.contains("software_limits_mm"))
      text += fmt::format(", software limits {}", a["software_limits_mm"].dump());
    if (a.contains("drive")) text += ", " + a["drive"].get<std::string>();
    if (a.contains("way")) text += fmt::format(", way \"{}\"", a["way"].get<std::string>());
    if (a.contains("reports_offset")) text += ", cannot report its offset";
    text += fmt::format("\n        errors {}; location {}\n", words(a["error_motions"]),
                        words(a["location_errors"]));
  }
  return text;
}

std::string correction_text(const json& facts) {
  std::string text;
  const json& c = facts["correction"];
  text += fmt::format("correcting axes {}: least authority {:.3f} at {}{}\n", words(c["axes"]),
                      c["least_authority"], place_text(c["at"]),
                      c["enough"].get<bool>()
                          ? ""
                          : fmt::format("; below {} nothing is corrected there", kMinAuthority));
  const json& o = facts["orientation"];
  if (o["rotary_axes"].empty()) {
    return text + "orientation errors: reported only, no rotary axis\n";
  }
  const bool corrected = o["corrected"].get<bool>();
  const double least = o["least_turning"].get<double>();
  text += fmt::format(
      "orientation errors: {}; least {:.3f} rad/rad at {}{}\n",
      corrected ? fmt::format("{} hold the axis of the tool (Z of its frame)", words(o["axes"]))
                : fmt::format("reported only; {} could turn the axis of the tool "
                              "(Z of its frame)",
                              words(o["rotary_axes"])),
      least, place_text(o["at"]),
      corrected && least < kMinTurning
          ? fmt::format("; below {} they let go by degrees", kMinTurning)
          : "");
  return text;
}

}  // namespace

json summary_of(const MachineFile& m) {
  const Vec3 tool = m.chain.tool_point();
  return {{"file", m.path},
          {"name", m.name},
          {"id", m.id},
          {"chain", chain_text(m.chain)},
          {"lower_body", lower_bodies(m)},
          {"bodies", body_facts(m)},
          {"tool_point_mm", {tool.x(), tool.y(), tool.z()}},
          {"axes", axis_facts(m)},
          {"correction", authority_facts(m)},
          {"offsets", offset_json(offset_facts(m))},
          {"orientation", orientation_facts(m)},
          {"model", model_of(m)},
          {"node_id", m.bus.node},
          {"controller_id", m.bus.controller},
          {"table_bytes", table_bytes(m, kDefaultKnots)}};
}

std::string summary_text(const json& facts) {
  std::string text = fmt::format("{}: {} (id {})\n", facts["file"], facts["name"], facts["id"]);
  text += fmt::format("chain {}, lower bodies {}\n", facts["chain"], words(facts["lower_body"]));
  text += text_of_section(body_table(facts));
  text += fmt::format("tool point {} mm in the frame of the last body of the tool\n",
                      facts["tool_point_mm"].dump());
  text += axes_text(facts) + correction_text(facts);
  text +=
      fmt::format("run-time model: {}; tables of {} bytes\n", facts["model"], facts["table_bytes"]);
  text += fmt::format("compensation node {}, controller {}\n", facts["node_id"],
                      facts["controller_id"]);
  return text;
}

std::string short_text(const MachineFile& m) {
  std::string text = fmt::format("{}: {} (id {}), good\n", m.path, m.name, m.id);
  text += fmt::format("workpiece: {}\ntool:      {}\n", branch_text(m, m.chain.work()),
                      branch_text(m, m.chain.tool()));
  for (const AxisFile& axis : m.axes)
    text += fmt::format("axis {}: {} {} to {} {}, {} targets, zero at {}\n", axis.letter,
                        axis.rotary ? "rotary" : "linear", axis.lo, axis.hi, unit_of(axis),
                        axis.targets, axis.reference);
  text += offset_text(offset_facts(m));
  text += fmt::format("run-time model: {}\n", model_of(m));
  if (!m.squareness) text += "no [squareness]: tables will hold no squareness\n";
  return text;
}

}  // namespace volcomp::host
