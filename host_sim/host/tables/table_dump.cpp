#include "host_sim/host/tables/table_dump.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/tables/image.hpp"
#include "host_sim/host/bus/thermal_diagnosis.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr double kUmPerNm = 1e-3;
constexpr std::array<const char*, 2> kTravelNames{"up", "down"};

MachineChain chain_of(const TableImage& image) {
  MachineChain chain;
  require(MachineChain::build(image.tables->machine, chain), image.name);
  return chain;
}

std::string letters_of(const MachineChain& chain, const std::uint8_t* axes, std::size_t count) {
  std::string letters;
  for (std::size_t i = 0; i < count; ++i)
    letters += chain.axis(axes[i]).letter;
  return letters.empty() ? "none" : letters;
}

// The stamp is zero-padded and need not be printable.
std::string stamp_of(const Provenance& p) {
  std::string text(p.stamp.begin(), std::find(p.stamp.begin(), p.stamp.end(), '\0'));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::string date_or(std::int64_t unix_s, const char* none) {
  return unix_s == 0 ? none : date_text(unix_s) + " UTC";
}

const char* kind_name(const Joint& joint) {
  switch (joint.kind) {
    case JointKind::prismatic:
      return "linear";
    case JointKind::rotary:
      return "rotary";
    case JointKind::fixed:
      break;
  }
  return "fixed";
}

double position_of(const AxisTable& table, const Joint& joint, std::size_t knot) {
  const auto units = static_cast<double>(table.q0 + table.pitch * static_cast<std::int64_t>(knot));
  return units / (joint.kind == JointKind::rotary ? kUnitsPerRad : kNmPerMm);
}

// um or urad.
double channel_of(const Channels& values, std::size_t channel) {
  return static_cast<double>(values[channel]) * (channel < 3 ? kUmPerNm : kUradPerRad);
}

std::string body_line(const Body& body, std::size_t number) {
  const Joint& j = body.joint;
  std::string text = fmt::format("body {} on {}: {}", number, body.lower, kind_name(j));
  if (j.moves())
    text += fmt::format(" {} {} {}{}", j.letter, j.kind == JointKind::rotary ? "about" : "along",
                        j.sign < 0 ? "-" : "+", "XYZ"[static_cast<std::size_t>(j.axis)]);
  text += fmt::format(", offset {} mm, orientation {}", fmt::join(j.offset, " "),
                      fmt::join(j.orientation, " "));
  if (!j.moves()) text += fmt::format(", error {} mm and rad", fmt::join(body.constant_error, " "));
  return text + "\n";
}

std::string axis_text(const MachineTables& tables, const MachineChain& chain, std::size_t a) {
  const Joint& joint = chain.axis(a);
  const AxisTable& t = tables.axis[a];
  const Vec3 direction = kUradPerRad * tables.directions[a];
  std::string text = fmt::format(
      "axis {}: {} knots from {} {}, pitch {}{}", joint.letter, t.knots, position_of(t, joint, 0),
      joint.kind == JointKind::rotary ? "rad" : "mm",
      position_of(t, joint, 1) - position_of(t, joint, 0), t.periodic ? ", a whole turn" : "");
  if (joint.kind == JointKind::prismatic)
    text += fmt::format(", direction off by {:.9g} {:.9g} {:.9g} urad", direction(0), direction(1),
                        direction(2));
  const AxisExpansion& e = tables.expansion[a];
  if (e.input != kNoTemperature)
    text +=
        fmt::format(", grows by {:.9g} um/(m K) from {:.9g} mm on, temperature {}",
                    1e6 * static_cast<double>(e.per_K), static_cast<double>(e.fixed_mm), e.input);
  return text + "\n";
}

json body_json(const Body& body) {
  const Joint& j = body.joint;
  json out{{"on", body.lower},
           {"kind", kind_name(j)},
           {"offset_mm", j.offset},
           {"orientation", j.orientation}};
  if (j.moves()) {
    out["letter"] = std::string(1, j.letter);
    out["along"] = std::string(1, "XYZ"[static_cast<std::size_t>(j.axis)]);
    out["sign"] = j.sign;
  } else {
    out["constant_error_mm_rad"] = body.constant_error;
  }
  return out;
}

json machine_json(const MachineDescription& d, const MachineChain& chain) {
  json bodies = json::array();
  for (std::size_t b = 0; b < d.body_count; ++b)
    bodies.push_back(body_json(d.body[b]));
  const auto letters = [&](const std::uint8_t* axes, std::size_t count) {
    json list = json::array();
    for (std::size_t i = 0; i < count; ++i)
      list.push_back(std::string(1, chain.axis(axes[i]).letter));
    return list;
  };
  return {{"chain", chain_text(chain)},
          {"bodies", bodies},
          {"work_body", d.work_body},
          {"tool_body", d.tool_body},
          {"tool_point_mm", d.tool_point},
          {"correcting", letters(d.correcting.data(), d.correcting_count)},
          {"orienting", letters(d.orienting.data(), d.orienting_count)}};
}

json axis_table_json(const MachineTables& tables, const MachineChain& chain, std::size_t a) {
  const Joint& joint = chain.axis(a);
  const AxisTable& t = tables.axis[a];
  json out{{"axis", std::string(1, joint.letter)},
           {"unit", joint.kind == JointKind::rotary ? "rad" : "mm"},
           {"periodic", t.periodic},
           {"channels", {"EX", "EY", "EZ", "EA", "EB", "EC"}},
           {"channel_units", {"um", "um", "um", "urad", "urad", "urad"}}};
  json& positions = out["position"] = json::array();
  for (std::size_t k = 0; k < t.knots; ++k)
    positions.push_back(position_of(t, joint, k));
  for (std::size_t travel = 0; travel < kTravelNames.size(); ++travel) {
    json& rows = out[kTravelNames[travel]] = json::array();
    for (std::size_t k = 0; k < t.knots; ++k) {
      json row = json::array();
      for (std::size_t c = 0; c < 6; ++c)
        row.push_back(channel_of(t.value[travel][k], c));
      rows.push_back(row);
    }
  }
  const Vec3 direction = kUradPerRad * tables.directions[a];
  out["direction_urad"] = {direction(0), direction(1), direction(2)};
  const AxisExpansion& e = tables.expansion[a];
  if (e.input != kNoTemperature)
    out["expansion"] = {{"per_K", static_cast<double>(e.per_K)},
                        {"fixed_mm", static_cast<double>(e.fixed_mm)},
                        {"input", e.input}};
  return out;
}

void add_rows(const AxisTable& table, const Joint& joint, std::string& text) {
  const bool rotary = joint.kind == JointKind::rotary;
  for (std::size_t k = 0; k < table.knots; ++k) {
    const double q = position_of(table, joint, k);
    const std::string place = rotary ? fmt::format(",{:.13f}", q) : fmt::format("{:.6f},", q);
    for (std::size_t travel = 0; travel < kTravelNames.size(); ++travel) {
      text += fmt::format("{},{},{},{}", joint.letter, k + 1, kTravelNames[travel], place);
      for (std::size_t c = 0; c < 6; ++c)
        text += fmt::format(",{:.9g}", channel_of(table.value[travel][k], c));
      text += '\n';
    }
  }
}

}  // namespace

std::string image_text(const TableImage& image) {
  const MachineTables& tables = *image.tables;
  const MachineDescription& d = tables.machine;
  const Provenance& p = tables.provenance;
  const MachineChain chain = chain_of(image);
  std::string text =
      fmt::format("{}: {} bytes, version {}, CRC-32 {:08X}\n", image.name, image.bytes,
                  kImageVersion, image.crc) +
      fmt::format("machine {}, chain {}, work holder body {}, tool holder body {}\n", p.machine_id,
                  chain_text(chain), d.work_body, d.tool_body) +
      fmt::format("built {}, expires {}, sequence {}, measured at {} deg C, stamp \"{}\"\n",
                  date_or(p.built_unix_s, "at an unknown time"), date_or(p.expires_unix_s, "never"),
                  p.sequence, p.temperature_C, stamp_of(p)) +
      fmt::format("tool point {} mm; axes that correct: {}; that orient the tool: {}\n",
                  fmt::join(d.tool_point, " "),
                  letters_of(chain, d.correcting.data(), d.correcting_count),
                  letters_of(chain, d.orienting.data(), d.orienting_count));
  for (std::size_t b = 0; b < d.body_count; ++b)
    text += body_line(d.body[b], b + 1);
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    text += axis_text(tables, chain, a);
  return text;
}

std::string tables_csv(const TableImage& image) {
  std::string text;
  const std::string about =
      image_text(image) + "values: of the body, on the moving side; up: towards larger positions\n";
  for (std::size_t at = 0; at < about.size();) {
    const std::size_t end = about.find('\n', at) + 1;
    text += "# " + about.substr(at, end - at);
    at = end;
  }
  text +=
      "axis,knot,direction,position [mm],position [rad],EX [um],EY [um],EZ [um],EA [urad],"
      "EB [urad],EC [urad]\n";
  const MachineChain chain = chain_of(image);
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    add_rows(image.tables->axis[a], chain.axis(a), text);
  return text;
}

json tables_json(const TableImage& image) {
  const MachineTables& tables = *image.tables;
  const Provenance& p = tables.provenance;
  const MachineChain chain = chain_of(image);
  json axes = json::array();
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    axes.push_back(axis_table_json(tables, chain, a));
  json provenance{{"machine_id", p.machine_id},
                  {"sequence", p.sequence},
                  {"temperature_C", static_cast<double>(p.temperature_C)},
                  {"stamp", stamp_of(p)}};
  if (p.built_unix_s != 0) provenance["built_utc"] = date_text(p.built_unix_s);
  if (p.expires_unix_s != 0) provenance["expires_utc"] = date_text(p.expires_unix_s);
  return {{"image", image.name},
          {"bytes", image.bytes},
          {"version", kImageVersion},
          {"crc32", fmt::format("{:08X}", image.crc)},
          {"provenance", provenance},
          {"machine", machine_json(tables.machine, chain)},
          {"convention", "body"},
          {"side", "moving"},
          {"axes", axes}};
}

}  // namespace volcomp::host
