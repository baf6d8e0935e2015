#pragma once
// Reads temperatures, expansion of the axes and the expiry of its tables from a node (2700h).

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/bus/node_client.hpp"

namespace volcomp::host {

// Null for a node that knows no temperatures. Throws as NodeClient::read.
[[nodiscard]] nlohmann::json diagnose_thermal(NodeClient& client);

// Names and values, a line each, for people.
void add_thermal_lines(const nlohmann::json& diagnosis,
                       std::vector<std::pair<std::string, std::string>>& lines);

// A date as text, UTC: "2030-01-01 00:00:00".
[[nodiscard]] std::string date_text(std::int64_t unix_s);

}  // namespace volcomp::host
