#include "host_sim/host/bus/drive_check/drive_route.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/object_handles.hpp"
#include "firmware/node/ways.hpp"
#include "host_sim/host/bus/setup.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

using canopen::ObjectId;
using canopen::PdoKind;

constexpr std::uint32_t kFlags = canopen::kPdoNoRtr;  // of a COB-ID, kept as they are
constexpr std::uint32_t kProbeEntry = canopen::mapped(0x60B9, 0, 16);
constexpr std::uint32_t kSave = 0x65766173;  // CiA 301, 7.5.2.13

std::uint16_t on(std::uint16_t function, std::uint8_t node) {
  return static_cast<std::uint16_t>(function + node);
}

std::vector<PdoPlan> wanted(std::uint8_t node, DriveRoute route) {
  const auto control = on(canopen::kRpdo1, node);
  const auto from_node = static_cast<std::uint16_t>(control + 0x100U);
  const auto status = on(canopen::kTpdo1, node);
  const PdoPlan whole{PdoKind::receive, 1, control, {}, {{kControlEntry, kTargetEntry}}};
  switch (route) {
    case DriveRoute::offset:
      return {
          whole,
          {PdoKind::receive, 2, from_node, kEverySync, {{kOffsetEntry}}},
          {PdoKind::transmit,
           1,
           status,
           kEverySync,
           {{kActualEntry, kStatusEntry, kProbeEntry}, {kActualEntry, kStatusEntry}}},
          {PdoKind::transmit, 4, on(canopen::kTpdo4, node), kEverySync, {{kOffsetEntry}}, true}};
    case DriveRoute::forwarded:
      // Skipped to the full length of the frame where the drive can.
      return {
          {PdoKind::receive,
           1,
           control,
           {},
           {control_and_four_bytes(), control_and_single_bytes(), control_alone()}},
          {PdoKind::receive, 2, from_node, kEverySync, {{kTargetEntry}}},
          {PdoKind::transmit, 1, status, kEverySync, {{kActualEntry, kStatusEntry, kModeEntry}}}};
    case DriveRoute::direct:
      return {whole, {PdoKind::receive, 2, 0}};
  }
  return {};
}

bool is_planned(const std::vector<PdoPlan>& plan, PdoKind kind, std::size_t number) {
  return std::any_of(plan.begin(), plan.end(),
                     [&](const PdoPlan& one) { return one.kind == kind && one.number == number; });
}

bool is_used(const std::vector<PdoPlan>& plan, std::uint16_t id) {
  return std::any_of(plan.begin(), plan.end(), [id](const PdoPlan& one) { return one.id == id; });
}

const ForeignPdo& pdo_of(const ForeignDrive& drive, const PdoPlan& plan) {
  const bool receive = plan.kind == PdoKind::receive;
  const std::vector<ForeignPdo>& pdos = receive ? drive.receive : drive.transmit;
  if (plan.number > pdos.size())
    throw UserError(
        fmt::format("node {} has no {}{}", drive.node, receive ? "RPDO" : "TPDO", plan.number));
  return pdos[plan.number - 1];
}

bool is_mapping_answer(canopen::AbortCode code) {
  return code != canopen::AbortCode::device_state && code != canopen::AbortCode::local_control;
}

// Writes and checks one PDO, in the order of CiA 301, 7.5.2.36.
class PdoWriter {
 public:
  PdoWriter(DriveChanges& changes, const ForeignDrive& drive, PdoPlan plan)
      : changes_(changes),
        drive_(drive),
        pdo_(pdo_of(drive, plan)),
        plan_(std::move(plan)),
        communication_(communication_of(plan_.kind, plan_.number)),
        mapping_(mapping_of(plan_.kind, plan_.number)) {}

  PdoPlan write() {
    changes_.keep(plan_.kind, pdo_);
    set({communication_, 1}, pdo_.cob_id | canopen::kPdoInvalid, 4);
    if (plan_.id == 0) return plan_;
    if (!map()) {
      plan_.id = 0;
      plan_.mappings.clear();
      return plan_;
    }
    if (plan_.type) set({communication_, 2}, *plan_.type, 1);
    if (plan_.kind == PdoKind::transmit) end_inhibition();
    set({communication_, 1}, (pdo_.cob_id & kFlags) | plan_.id, 4);
    return plan_;
  }

 private:
  void set(ObjectId object, std::uint32_t value, std::size_t bytes) {
    changes_.write(object, value, bytes);
    if (changes_.read(object) != value)
      throw UserError(fmt::format("{} of node {} does not hold what was written",
                                  object_name(object), drive_.node));
  }

  // Some drives have an inhibit time of a tenth of a second after power-on.
  void end_inhibition() {
    const ObjectId inhibit_time{communication_, 3};
    try {
      if (changes_.read(inhibit_time) == 0) return;
    } catch (const NodeRefused&) {  // it has none
      return;
    }
    set(inhibit_time, 0, 2);
  }

  // False: none of the mappings, and it may be left out.
  bool map() {
    for (const Mapping& entries : plan_.mappings) {
      if (!takes(entries)) continue;
      plan_.mappings = {entries};
      return true;
    }
    if (plan_.dispensable) return false;
    throw UserError(fmt::format("node {} does not take {}", drive_.node, describe(plan_)));
  }

  bool takes(const Mapping& entries) {
    try {
      set({mapping_, 0}, 0, 1);
      for (std::size_t i = 0; i < entries.size(); ++i)
        set({mapping_, static_cast<std::uint8_t>(i + 1)}, entries[i], 4);
      set({mapping_, 0}, static_cast<std::uint32_t>(entries.size()), 1);
      return true;
    } catch (const NodeRefused& refused) {
      if (!is_mapping_answer(refused.code)) throw;
      return false;
    }
  }

  DriveChanges& changes_;
  const ForeignDrive& drive_;
  const ForeignPdo& pdo_;
  PdoPlan plan_;
  std::uint16_t communication_;
  std::uint16_t mapping_;
};

}  // namespace

std::vector<PdoPlan> plan_of(const ForeignDrive& drive, DriveRoute route) {
  std::vector<PdoPlan> plan = wanted(drive.node, route);
  // What the drive does not have need not be switched off.
  plan.erase(std::remove_if(plan.begin(), plan.end(),
                            [&drive](const PdoPlan& one) {
                              const bool receive = one.kind == PdoKind::receive;
                              const std::size_t there =
                                  receive ? drive.receive.size() : drive.transmit.size();
                              return (one.id == 0 || one.dispensable) && one.number > there;
                            }),
             plan.end());
  std::vector<PdoPlan> off;
  for (const ForeignPdo& pdo : drive.receive) {
    const bool disturbs =
        is_used(plan, pdo.id()) || pdo.maps(0x6040) || pdo.maps(0x607A) || pdo.maps(0x60B0);
    if (pdo.valid() && disturbs && !is_planned(plan, PdoKind::receive, pdo.number))
      off.push_back({PdoKind::receive, pdo.number, 0});
  }
  for (const ForeignPdo& pdo : drive.transmit) {
    if (pdo.valid() && is_used(plan, pdo.id()) && !is_planned(plan, PdoKind::transmit, pdo.number))
      off.push_back({PdoKind::transmit, pdo.number, 0});
  }
  // First, so that no two of them are valid together.
  off.insert(off.end(), plan.begin(), plan.end());
  return off;
}

std::string describe(const PdoPlan& plan) {
  std::string text =
      fmt::format("{}{}: ", plan.kind == PdoKind::receive ? "RPDO" : "TPDO", plan.number);
  if (plan.id == 0) return text + "invalid";
  text += fmt::format("{:03X}h", plan.id);
  for (std::size_t i = 0; i < plan.mappings.size(); ++i)
    text += fmt::format("{} {{{}}}", i == 0 ? "" : " or", mapping_text(plan.mappings[i]));
  if (plan.type) text += fmt::format(", type {}", *plan.type);
  return text;
}

std::vector<PdoPlan> set_route(DriveChanges& changes, const ForeignDrive& drive,
                               const std::vector<PdoPlan>& plan) {
  std::vector<PdoPlan> done;
  changes.run_or_restore([&] {
    for (const PdoPlan& one : plan)
      done.push_back(PdoWriter(changes, drive, one).write());
  });
  return done;
}

void require_node_ready(NodeClient& client, std::size_t axis, std::uint8_t drive) {
  constexpr std::uint64_t kHeartbeat_us = 1'000'000;
  const auto state = client.await_heartbeat(kHeartbeat_us);
  refuse_while_following(client, state);
  if (state != canopen::NmtState::pre_operational)
    throw UserError(fmt::format("node {} must be PRE-OPERATIONAL, and {}: nothing was written",
                                client.node_id(),
                                state ? "is not" : "sends no heartbeat that tells"));
  const auto way = client.find(node::object::way[axis - 1]);
  if (!way)
    throw UserError(
        fmt::format("node {} is no compensation node that knows ways (2034h)", client.node_id()));
  const unsigned own = client.read(node::object::drive[axis - 1]);
  if (own != drive)
    throw UserError(
        fmt::format("axis {} of node {} has drive {} (2010h), not {}: volcomp setup "
                    "writes it",
                    axis, client.node_id(), own, drive));
}

void set_node_way(NodeClient& client, std::size_t axis, DriveRoute route) {
  const auto write = [&](const auto& object, auto value) {
    client.write(object.id(), {static_cast<std::uint8_t>(value)}, object.name);
  };
  const node::Way way = route == DriveRoute::direct      ? node::Way::none
                        : route == DriveRoute::forwarded ? node::Way::forwarded_target
                                                         : node::Way::offset;
  write(node::object::way[axis - 1], way);
  if (way == node::Way::forwarded_target) write(node::object::mapped_way[axis - 1], way);
}

void store_in_drive(NodeClient& client) {
  client.write({0x1010, 1},
               {kSave & 0xFFU, kSave >> 8U & 0xFFU, kSave >> 16U & 0xFFU, kSave >> 24U}, "1010h");
}

}  // namespace volcomp::host
