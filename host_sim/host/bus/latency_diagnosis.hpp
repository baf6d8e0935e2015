#pragma once
// Whether the node answers in time on its bus: 2620h beside what axes, ways, 1006h and 2200h:03
// leave it. And which axis is not served, where targets are forwarded.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/bus/bus_cycle.hpp"
#include "host_sim/host/bus/node_client.hpp"

namespace volcomp::host {

// What 2620h says, µs.
struct MeasuredLatency {
  std::uint32_t cycles = 0;
  std::uint32_t largest = 0;
};

// What is too long, a sentence each; none: it fits. The deadline counts for forwarded targets only:
// an offset that comes late acts with the next target, a target that comes late is missed.
// `probing`: edges of a touch probe are reported.
[[nodiscard]] std::vector<std::string> latency_problems(const CycleAxes& axes,
                                                        const LatencyBudget& budget,
                                                        const MeasuredLatency& measured,
                                                        bool probing);

// `axes`: of the diagnosis. "fits" is null where nothing was measured or 1006h is 0. Throws as
// NodeClient::read.
[[nodiscard]] nlohmann::json diagnose_latency(NodeClient& client, const nlohmann::json& axes);
// Sentences for people; empty where no axis has a drive.
[[nodiscard]] std::string describe_latency(const nlohmann::json& d);

// Way and mapping of an axis, and "not_served": why its drive gets no targets as far as objects
// tell; null: nothing is known to be in the way. `status`: 6041h.
void add_way_facts(NodeClient& client, std::size_t axis, nlohmann::json& facts);
// The same for people, where it is not the offset; otherwise empty.
[[nodiscard]] std::string describe_way(const nlohmann::json& axis);
// Bit 15 of 2600h:03 and 2603h, null where no axis is forwarded.
[[nodiscard]] nlohmann::json diagnose_forwarding(NodeClient& client, const nlohmann::json& axes);
[[nodiscard]] std::string describe_forwarding(const nlohmann::json& d);

}  // namespace volcomp::host
