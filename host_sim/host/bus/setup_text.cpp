// A set-up for people, as a table, and for programs.

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/host/bus/setup.hpp"

namespace volcomp::host {
namespace {

double real_of(std::uint64_t bits) {
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::int64_t signed_of(canopen::DataType type, std::uint64_t bits) {
  const std::size_t unused = 64 - 8 * canopen::size_of(type);
  return static_cast<std::int64_t>(bits << unused) >> unused;
}

std::string object_name(canopen::ObjectId object) {
  return fmt::format("{:04X}h:{:02X}", object.index, object.sub);
}

// `bits` as the value of this object.
std::string value_text(const PlannedValue& v, std::uint64_t bits) {
  if (v.type == canopen::DataType::real64) return fmt::format("{}", real_of(bits));
  if (v.hexadecimal) return fmt::format("{:0{}X}h", bits, 2 * canopen::size_of(v.type));
  if (canopen::is_signed(v.type)) return fmt::format("{}", signed_of(v.type, bits));
  return fmt::format("{}", bits);
}

nlohmann::json value_json(const PlannedValue& v, std::uint64_t bits) {
  if (v.type == canopen::DataType::real64) return real_of(bits);
  if (canopen::is_signed(v.type)) return signed_of(v.type, bits);
  return bits;
}

nlohmann::json planned_json(const PlannedValue& v) {
  return {{"object", object_name(v.object)},
          {"name", v.name},
          {"value", value_json(v, v.bits)},
          {"unit", v.unit}};
}

// A line of the table.
struct Line {
  std::string object;
  std::string name;
  std::string value;
  std::string unit;
  std::string remark;
};

std::string table_text(const std::vector<Line>& lines) {
  std::size_t name = 0;
  std::size_t value = 0;
  std::size_t unit = 0;
  for (const Line& line : lines) {
    name = std::max(name, line.name.size());
    value = std::max(value, line.value.size());
    unit = std::max(unit, line.unit.size());
  }
  std::string text;
  for (const Line& l : lines) {
    std::string row = fmt::format("{:<8}  {:<{}}  {:>{}}  {:<{}}  {}", l.object, l.name, name,
                                  l.value, value, l.unit, unit, l.remark);
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

std::string remark_on(const SetupValue& v) {
  std::string text = v.differed() ? "was " + value_text(v.planned, v.before) : std::string();
  if (!v.kept())
    text +=
        fmt::format("{}READ BACK AS {}", text.empty() ? "" : ", ", value_text(v.planned, v.after));
  return text;
}

}  // namespace

std::string describe(const SetupPlan& plan) {
  std::vector<Line> lines{{"object", "name", "value", "unit", ""}};
  for (const PlannedValue& v : plan)
    lines.push_back({object_name(v.object), v.name, value_text(v, v.bits), v.unit, ""});
  return table_text(lines);
}

std::string describe(const SetupResult& result) {
  std::vector<Line> lines{{"object", "name", "value", "unit", "before"}};
  for (const SetupValue& v : result.values)
    lines.push_back({object_name(v.planned.object), v.planned.name,
                     value_text(v.planned, v.planned.bits), v.planned.unit, remark_on(v)});
  const auto count = [&result](bool (SetupValue::*is)() const) {
    return std::count_if(result.values.begin(), result.values.end(),
                         [is](const SetupValue& v) { return (v.*is)(); });
  };
  std::string text = table_text(lines);
  text += fmt::format(
      "node {} ({}): {} objects written, {} of them differed before, {} read back as written\n",
      result.node, result.device, result.values.size(), count(&SetupValue::differed),
      count(&SetupValue::kept));
  if (result.tables)
    text += fmt::format("active: CRC-32 {:08X}, sequence number {}\n", result.tables->crc,
                        result.tables->sequence);
  text += result.stored ? "stored\n" : "not stored: lost at the next start of the node\n";
  return text;
}

nlohmann::json to_json(const SetupPlan& plan) {
  nlohmann::json values = nlohmann::json::array();
  for (const PlannedValue& v : plan)
    values.push_back(planned_json(v));
  return values;
}

nlohmann::json to_json(const SetupResult& result) {
  nlohmann::json values = nlohmann::json::array();
  for (const SetupValue& v : result.values) {
    nlohmann::json value = planned_json(v.planned);
    value["before"] = value_json(v.planned, v.before);
    value["read_back"] = value_json(v.planned, v.after);
    values.push_back(value);
  }
  nlohmann::json json{{"node", result.node},
                      {"device", result.device},
                      {"objects", values},
                      {"ok", result.ok()},
                      {"stored", result.stored}};
  if (result.tables) json["active_crc"] = fmt::format("{:08X}", result.tables->crc);
  return json;
}

}  // namespace volcomp::host
