#pragma once
// Listens to a bus before anything is sent: who is there, and whose SDO server somebody else uses.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <nlohmann/json.hpp>

#include "firmware/canopen/nmt.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"

namespace volcomp::host {

struct HeardNode {
  std::optional<canopen::NmtState> state;    // of its last heartbeat or boot-up
  bool sdo_in_use = false;                   // a request or an answer was heard
  std::uint64_t frames = 0;                  // that come from it, by the predefined identifiers
  std::optional<std::uint32_t> device_type;  // 1000h, where it was asked
};
using HeardNodes = std::map<std::uint8_t, HeardNode>;  // by node id

// Never sends. Throws what the link throws, and Interrupted. `identifiers`: takes those of all
// frames.
[[nodiscard]] HeardNodes listen(FrameLink& link, std::uint64_t duration_us,
                                std::set<std::uint16_t>* identifiers = nullptr);

// Reads 1000h of every node whose SDO server was quiet; who does not answer within 50 ms is not
// there. `progress`: with the node id.
void ask_all(const std::shared_ptr<FrameLink>& link, HeardNodes& heard,
             const std::function<void(std::uint8_t)>& progress = {});

[[nodiscard]] std::string describe(const HeardNodes& heard);
[[nodiscard]] nlohmann::json to_json(const HeardNodes& heard);

}  // namespace volcomp::host
