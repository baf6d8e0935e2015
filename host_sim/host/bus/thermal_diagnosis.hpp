#pragma once
// Reads temperatures, expansion of the axes and the expiry of its tables from a node (2700h).

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "firmware/node/thermal/thermal_objects.hpp"
#include "host_sim/host/bus/node_client.hpp"

namespace volcomp::host {

struct TemperatureDiagnosis {
  double latest_C = 0.0;  // as received, accepted or not
  bool connected = false;
  TemperatureState state{};
};

struct ThermalDiagnosis {
  node::ThermalState state{};
  double behind_um = 0.0;
  std::uint32_t followed = 0;  // times the tables did
  std::array<TemperatureDiagnosis, kTemperatureInputs> input{};
  std::uint32_t unix_s = 0;          // 0: the node has no date
  std::uint32_t expires_unix_s = 0;  // 0: never
  bool expired = false;
};

// Nothing for a node that knows no temperatures. Throws as NodeClient::read.
[[nodiscard]] std::optional<ThermalDiagnosis> diagnose_thermal(NodeClient& client);

// Names and values, a line each, for people.
void add_lines(const ThermalDiagnosis& diagnosis,
               std::vector<std::pair<std::string, std::string>>& lines);
[[nodiscard]] nlohmann::json to_json(const ThermalDiagnosis& diagnosis);

// A date as text, UTC: "2030-01-01 00:00:00".
[[nodiscard]] std::string date_text(std::int64_t unix_s);

}  // namespace volcomp::host
