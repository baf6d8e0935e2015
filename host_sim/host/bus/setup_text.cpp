// A set-up for people, as a table, and for programs.

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/host/bus/setup.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

std::int64_t signed_of(canopen::DataType type, std::uint64_t bits) {
  const std::size_t unused = 64 - 8 * canopen::size_of(type);
  return static_cast<std::int64_t>(bits << unused) >> unused;
}

std::string object_name(canopen::ObjectId object) {
  return fmt::format("{:04X}h:{:02X}", object.index, object.sub);
}

nlohmann::json value_json(const PlannedValue& v, std::uint64_t bits) {
  if (v.type == canopen::DataType::real64) return bit_cast<double>(bits);
  if (canopen::is_signed(v.type)) return signed_of(v.type, bits);
  return bits;
}

// For people: as the object is usually written.
nlohmann::json value_shown(const PlannedValue& v, std::uint64_t bits) {
  if (v.hexadecimal) return fmt::format("{:0{}X}h", bits, 2 * canopen::size_of(v.type));
  return value_json(v, bits);
}

std::string value_text(const PlannedValue& v, std::uint64_t bits) {
  const nlohmann::json value = value_shown(v, bits);
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
}

nlohmann::json row_of(const PlannedValue& v) {
  return {object_name(v.object), v.name, value_json(v, v.bits), value_shown(v, v.bits), v.unit};
}

nlohmann::json columns() {
  return {plain_column("object", "object"), plain_column("name", "name"), hidden_column("value"),
          plain_column("value"), plain_column("unit", "unit")};
}

std::string remark_on(const SetupValue& v) {
  std::string text = v.differed() ? "was " + value_text(v.planned, v.before) : std::string();
  if (!v.kept())
    text +=
        fmt::format("{}READ BACK AS {}", text.empty() ? "" : ", ", value_text(v.planned, v.after));
  return text;
}

nlohmann::json table_of(const SetupPlan& plan) {
  nlohmann::json rows = nlohmann::json::array();
  for (const PlannedValue& v : plan)
    rows.push_back(row_of(v));
  return table_section("", columns(), std::move(rows));
}

nlohmann::json table_of(const std::vector<SetupValue>& values) {
  nlohmann::json all = columns();
  all.push_back(plain_column("before"));
  all.push_back(hidden_column("before"));
  all.push_back(hidden_column("read_back"));
  nlohmann::json rows = nlohmann::json::array();
  for (const SetupValue& v : values) {
    rows.push_back(row_of(v.planned));
    rows.back().push_back(remark_on(v));
    rows.back().push_back(value_json(v.planned, v.before));
    rows.back().push_back(value_json(v.planned, v.after));
  }
  return table_section("", std::move(all), std::move(rows));
}

}  // namespace

std::string describe(const SetupPlan& plan) { return text_of_section(table_of(plan)); }

std::string describe(const SetupResult& result) {
  const auto count = [&result](bool (SetupValue::*is)() const) {
    return std::count_if(result.values.begin(), result.values.end(),
                         [is](const SetupValue& v) { return (v.*is)(); });
  };
  std::vector<std::string> lines{fmt::format(
      "node {} ({}): {} objects written, {} of them differed before, {} read back as written",
      result.node, result.device, result.values.size(), count(&SetupValue::differed),
      count(&SetupValue::kept))};
  if (result.tables)
    lines.push_back(fmt::format("active: CRC-32 {:08X}, sequence number {}", result.tables->crc,
                                result.tables->sequence));
  lines.emplace_back(result.stored ? "stored" : "not stored: lost at the next start of the node");
  return text_of_sections({table_of(result.values), text_section("", lines)});
}

nlohmann::json to_json(const SetupPlan& plan) { return figures_of_table(table_of(plan)); }

nlohmann::json to_json(const SetupResult& result) {
  nlohmann::json json{{"node", result.node},
                      {"device", result.device},
                      {"objects", figures_of_table(table_of(result.values))},
                      {"ok", result.ok()},
                      {"stored", result.stored}};
  if (result.tables) json["active_crc"] = fmt::format("{:08X}", result.tables->crc);
  return json;
}

}  // namespace volcomp::host
