#include "host_sim/host/bus/thermal_diagnosis.hpp"

#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/report/json_format.hpp"

namespace volcomp::host {
namespace {

namespace thermal = node::object::thermal;
using nlohmann::json;

// By ThermalState.
constexpr std::array kStates{
    "none", "the tables follow the temperatures", "the tables are about to follow a temperature",
    "held: the active image is no longer in the node, activate tables to go on"};
// By TemperatureState.
constexpr std::array kInputStates{"none yet, as at the reference", "good",
                                  "none for too long, the last good one is used",
                                  "not plausible, the last good one is used"};

json diagnose_input(NodeClient& client, std::size_t input) {
  const std::int16_t reading = client.read(thermal::reading[input]);
  const bool connected = reading != TemperatureInput::kNone;
  return {{"latest_C", connected ? json(0.01 * reading) : json()},
          {"state", word_of(kInputStates, client.read(thermal::input[input]))}};
}

std::string expiry_text(const json& d) {
  if (d["expires_unix_s"] == 0) return "never";
  const std::string date = date_text(d["expires_unix_s"]);
  if (d["unix_s"] == 0) return date + " (the node does not know the date)";
  return d["expired"] ? date + ", PAST: measure the machine again" : date;
}

}  // namespace

std::string date_text(std::int64_t unix_s) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(static_cast<std::time_t>(unix_s)));
}

json diagnose_thermal(NodeClient& client) {
  const auto state = client.find(thermal::state);
  if (!state) return nullptr;
  json d{{"state", word_of(kStates, *state)},
         {"behind_um", 1e-3 * client.read(thermal::behind_nm)},
         {"expired", client.read(thermal::expired) != 0}};
  read_facts(client, d, thermal::followed, thermal::unix_s, thermal::expires_unix_s);
  for (std::size_t i = 0; i < kTemperatureInputs; ++i)
    d["temperatures"].push_back(diagnose_input(client, i));
  return d;
}

void add_thermal_lines(const json& d, std::vector<std::pair<std::string, std::string>>& lines) {
  lines.emplace_back("tables expire:", expiry_text(d));
  lines.emplace_back("expansion:", d["state"]);
  if (d["state"] != kStates[0])
    lines.back().second +=
        fmt::format(" ({} times so far, {:.3f} µm behind)", d["followed"], d["behind_um"]);
  for (std::size_t i = 0; i < d["temperatures"].size(); ++i) {
    const json& input = d["temperatures"][i];
    const bool connected = !input["latest_C"].is_null();
    if (connected || input["state"] != kInputStates[0])
      lines.emplace_back(fmt::format("temperature {}:", i),
                         connected
                             ? fmt::format("{:.2f} deg C, {}", input["latest_C"], input["state"])
                             : fmt::format("no sensor, {}", input["state"]));
  }
}

}  // namespace volcomp::host
