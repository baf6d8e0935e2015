#pragma once
// Describes the strokes that a node of a helical grinder watches and what it has learned from them
// (firmware/node/strokes/stroke_objects.hpp).

#include <string>

#include <nlohmann/json.hpp>

#include "firmware/node/strokes/stroke_objects.hpp"
#include "host_sim/host/bus/node_client.hpp"

namespace volcomp::host {

// Null for a node that does not know strokes. Throws as NodeClient::read.
[[nodiscard]] nlohmann::json diagnose_strokes(NodeClient& client);

// Of the values that a node has.
[[nodiscard]] nlohmann::json stroke_facts(const node::StrokeObjects& objects);

// "" when strokes are off.
[[nodiscard]] std::string describe_strokes(const nlohmann::json& diagnosis);

}  // namespace volcomp::host
