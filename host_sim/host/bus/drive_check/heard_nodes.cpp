#include "host_sim/host/bus/drive_check/heard_nodes.hpp"

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/host/bus/drive_check/foreign_drive.hpp"
#include "host_sim/host/bus/node_client.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

constexpr std::uint16_t kIdBits = 0x7F;

// EMCY, TPDOs, SDO answers and heartbeats come from the node whose id they carry.
bool comes_from_its_node(std::uint16_t function) {
  return function == canopen::kEmergency || function == canopen::kTpdo1 ||
         function == canopen::kTpdo2 || function == canopen::kTpdo3 ||
         function == canopen::kTpdo4 || function == canopen::kSdoResponse ||
         function == canopen::kHeartbeat;
}

void take(HeardNodes& heard, const hal::CanFrame& frame) {
  const auto node = static_cast<std::uint8_t>(frame.id & kIdBits);
  const auto function = static_cast<std::uint16_t>(frame.id & ~kIdBits);
  // After a command the state is another one, until the node says which.
  if (frame.id == canopen::kNmt) {
    for (auto& [id, one] : heard) {
      if (frame.data[1] == 0 || frame.data[1] == id) one.state.reset();
    }
  }
  if (node == 0) return;  // SYNC, NMT, TIME
  const bool sdo = function == canopen::kSdoRequest || function == canopen::kSdoResponse;
  if (!sdo && !comes_from_its_node(function)) return;
  HeardNode& one = heard[node];
  if (sdo) one.sdo_in_use = true;
  if (function != canopen::kSdoRequest) ++one.frames;
  if (function == canopen::kHeartbeat && frame.size == 1)
    one.state = static_cast<canopen::NmtState>(frame.data[0] & 0x7FU);
}

const char* title(const std::optional<canopen::NmtState>& state) {
  if (!state) return "unknown";
  switch (*state) {
#define NMT_STATE(number, name, title, words) \
  case canopen::NmtState::name:               \
    return title;
#include "firmware/canopen/codes.def"
  }
  return "unknown";
}

std::string device_text(const HeardNode& node) {
  if (!node.device_type) return node.sdo_in_use ? "not asked: its SDO server is in use" : "";
  return is_cia402(*node.device_type) ? "CiA 402 drive"
                                      : fmt::format("profile {}", *node.device_type & 0xFFFFU);
}

}  // namespace

HeardNodes listen(FrameLink& link, std::uint64_t duration_us,
                  std::set<std::uint16_t>* identifiers) {
  constexpr std::uint32_t kWait_us = 10'000;
  const Interruption interruption;
  HeardNodes heard;
  const std::uint64_t begin_us = link.now_us();
  while (link.now_us() - begin_us < duration_us) {
    interruption.check();
    link.wait(kWait_us);
    hal::CanFrame frame;
    // A babbling node must not keep us here.
    while (link.now_us() - begin_us < duration_us && link.receive(frame)) {
      take(heard, frame);
      if (identifiers != nullptr) identifiers->insert(frame.id);
    }
  }
  return heard;
}

void ask_all(const std::shared_ptr<FrameLink>& link, HeardNodes& heard,
             const std::function<void(std::uint8_t)>& progress) {
  constexpr std::uint64_t kTimeout_us = 50'000;
  const Interruption interruption;
  for (std::uint8_t node = 1; node <= canopen::kMaxNodeId; ++node) {
    interruption.check();
    const auto known = heard.find(node);
    if (known != heard.end() && known->second.sdo_in_use) continue;
    if (progress) progress(node);
    NodeClient client(node, LinkPump(link));
    client.set_timeout_us(kTimeout_us);
    try {
      const auto type = client.read(canopen::object::device_type);
      heard[node].device_type = type;
    } catch (const NodeRefused&) {
      heard[node].device_type = 0;
    } catch (const UserError&) {  // nobody there
    }
  }
}

std::string describe(const HeardNodes& heard) {
  if (heard.empty()) return "nobody was heard\n";
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& [id, node] : heard)
    rows.push_back({id, title(node.state), node.frames, device_text(node)});
  return text_of_section(table_section(
      "",
      {plain_column("node"), plain_column("state"), plain_column("frames"), plain_column("device")},
      std::move(rows)));
}

nlohmann::json to_json(const HeardNodes& heard) {
  nlohmann::json nodes = nlohmann::json::array();
  for (const auto& [id, node] : heard) {
    nlohmann::json one{{"node", id},
                       {"state", title(node.state)},
                       {"frames", node.frames},
                       {"sdo_in_use", node.sdo_in_use}};
    if (node.device_type) {
      one["device_type"] = *node.device_type;
      one["drive"] = is_cia402(*node.device_type);
    }
    nodes.push_back(std::move(one));
  }
  return {{"nodes", nodes}};
}

}  // namespace volcomp::host
