#include "host_sim/host/bus/thermal_diagnosis.hpp"

#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace volcomp::host {
namespace {

namespace thermal = node::object::thermal;

TemperatureDiagnosis diagnose_input(NodeClient& client, std::size_t input) {
  TemperatureDiagnosis d;
  const std::int16_t reading = client.read(thermal::reading[input]);
  d.connected = reading != TemperatureInput::kNone;
  d.latest_C = 0.01 * reading;
  d.state = client.read<TemperatureState>(thermal::input[input]);
  return d;
}

const char* words(node::ThermalState state) {
  switch (state) {
    case node::ThermalState::off:
      return "none";
    case node::ThermalState::following:
      return "the tables follow the temperatures";
    case node::ThermalState::behind:
      return "the tables are about to follow a temperature";
    case node::ThermalState::held:
      return "held: the active image is no longer in the node, activate tables to go on";
  }
  return "unknown";
}

const char* words(TemperatureState state) {
  switch (state) {
    case TemperatureState::unknown:
      return "none yet, as at the reference";
    case TemperatureState::good:
      return "good";
    case TemperatureState::stale:
      return "none for too long, the last good one is used";
    case TemperatureState::implausible:
      return "not plausible, the last good one is used";
  }
  return "unknown";
}

std::string input_text(const TemperatureDiagnosis& d) {
  return d.connected ? fmt::format("{:.2f} deg C, {}", d.latest_C, words(d.state))
                     : fmt::format("no sensor, {}", words(d.state));
}

std::string expiry_text(const ThermalDiagnosis& d) {
  if (d.expires_unix_s == 0) return "never";
  const std::string date = date_text(d.expires_unix_s);
  if (d.unix_s == 0) return date + " (the node does not know the date)";
  return d.expired ? date + ", PAST: measure the machine again" : date;
}

}  // namespace

std::string date_text(std::int64_t unix_s) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(static_cast<std::time_t>(unix_s)));
}

std::optional<ThermalDiagnosis> diagnose_thermal(NodeClient& client) {
  ThermalDiagnosis d;
  try {
    d.state = client.read<node::ThermalState>(thermal::state);
  } catch (const NodeRefused& refused) {
    if (refused.code == canopen::AbortCode::no_object) return std::nullopt;
    throw;
  }
  d.behind_um = 1e-3 * client.read(thermal::behind_nm);
  d.followed = client.read(thermal::followed);
  for (std::size_t i = 0; i < d.input.size(); ++i)
    d.input[i] = diagnose_input(client, i);
  d.unix_s = client.read(thermal::unix_s);
  d.expires_unix_s = client.read(thermal::expires_unix_s);
  d.expired = client.read(thermal::expired) != 0;
  return d;
}

void add_lines(const ThermalDiagnosis& d, std::vector<std::pair<std::string, std::string>>& lines) {
  lines.emplace_back("tables expire:", expiry_text(d));
  lines.emplace_back("expansion:", words(d.state));
  if (d.state != node::ThermalState::off)
    lines.back().second +=
        fmt::format(" ({} times so far, {:.3f} µm behind)", d.followed, d.behind_um);
  for (std::size_t i = 0; i < d.input.size(); ++i) {
    const bool idle = !d.input[i].connected && d.input[i].state == TemperatureState::unknown;
    if (!idle) lines.emplace_back(fmt::format("temperature {}:", i), input_text(d.input[i]));
  }
}

nlohmann::json to_json(const ThermalDiagnosis& d) {
  nlohmann::json inputs = nlohmann::json::array();
  for (const TemperatureDiagnosis& input : d.input) {
    inputs.push_back({{"latest_C", input.connected ? nlohmann::json(input.latest_C) : nullptr},
                      {"state", words(input.state)}});
  }
  return {{"state", words(d.state)}, {"behind_um", d.behind_um},
          {"followed", d.followed},  {"temperatures", inputs},
          {"unix_s", d.unix_s},      {"expires_unix_s", d.expires_unix_s},
          {"expired", d.expired}};
}

}  // namespace volcomp::host
