// A check of a drive for people, as a table and sentences, and for programs.

#include <fmt/format.h>

#include "host_sim/host/bus/drive_check/drive_check.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

nlohmann::json table_of(const DriveCheck& check) {
  nlohmann::json rows = nlohmann::json::array();
  for (const DriveFact& f : check.facts)
    rows.push_back(nlohmann::json::array({f.title, f.value, f.objects}));
  nlohmann::json table = table_section(
      "", {plain_column("what"), plain_column("value"), plain_column("objects")}, std::move(rows));
  table["head"] = false;
  return table;
}

// "way 0 (offset by 60B0h), unconfirmed".
std::string way_text(const DriveCheck& check) {
  if (check.best == Way::none) return "no way fits";
  std::string text = fmt::format("way {} ({})", static_cast<int>(check.best), words_of(check.best));
  if (check.best == Way::offset && check.confirmed)
    text += *check.confirmed ? ", confirmed" : ", unconfirmed";
  if (!check.best_is_sure)
    text += fmt::format(" fits if a PDO takes {}h", check.best == Way::offset ? "60B0" : "607A");
  return text;
}

nlohmann::json truth_of(const std::optional<bool>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

}  // namespace

std::string describe(const DriveCheck& check) {
  std::string text = fmt::format("node {}: {}\n", check.node, check.name);
  text += text_of_section(table_of(check));
  text += fmt::format("verdict: {}\n", way_text(check));
  for (const std::string& sentence : check.missing)
    text += fmt::format("missing: {}\n", sentence);
  for (const std::string& sentence : check.warnings)
    text += fmt::format("mind: {}\n", sentence);
  return text;
}

nlohmann::json to_json(const DriveCheck& check) {
  nlohmann::json facts = nlohmann::json::object();
  for (const DriveFact& f : check.facts)
    facts[f.key] = {{"value", f.value}, {"objects", f.objects}};
  return {{"node", check.node},
          {"name", check.name},
          {"facts", facts},
          {"way", check.best == Way::none ? nlohmann::json()
                                          : nlohmann::json(static_cast<int>(check.best))},
          {"way_is_sure", truth_of(check.best_is_sure)},
          {"confirmed", truth_of(check.confirmed)},
          {"good", check.good()},
          {"missing", check.missing},
          {"warnings", check.warnings}};
}

}  // namespace volcomp::host
