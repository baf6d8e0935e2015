#include "host_sim/host/bus/drive_plan.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/node_objects.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"
#include "host_sim/host/bus/drive_model.hpp"

namespace volcomp::host {
namespace {

using canopen::PdoKind;
using canopen::PdoTable;
using Mapping = std::vector<std::uint32_t>;

constexpr std::uint8_t kCyclic = 1;
constexpr std::uint8_t kAfterEvent = 0;  // after an event

// The PDOs of a drive by number, from 0; one that maps nothing is off.
struct WantedPdo {
  std::uint8_t type = kCyclic;
  Mapping mapping;
};
using WantedPdos = std::vector<WantedPdo>;

WantedPdos received_by(Way way) {
  const Mapping both{cia402::controlword.mapped(), cia402::target.mapped()};
  switch (way) {
    case Way::offset:
      return {{kCyclic, both}, {kCyclic, {cia402::offset.mapped()}}};
    case Way::forwarded_target:
      return {{kCyclic, {cia402::controlword.mapped()}}, {kCyclic, {cia402::target.mapped()}}};
    default:
      return {{kCyclic, both}};
  }
}

// A drive without a data sheet has everything.
bool latches(const BusAxis& axis) { return axis.model == nullptr || axis.model->latches(); }

// What the drive says every cycle, of a latch, of the edge behind it, of the offset it has taken.
WantedPdos sent_by(const BusAxis& axis, bool probes) {
  const bool forwarded = axis.way == Way::forwarded_target;
  WantedPdos pdos(kTransmitPdos);
  Mapping& actual = pdos[kActualPdo].mapping;
  actual = {cia402::actual.mapped(), cia402::statusword.mapped()};
  if (forwarded)
    actual.push_back(cia402::mode_display.mapped());
  else if (latches(axis))
    actual.push_back(cia402::status.mapped());
  if (probes) {
    pdos[kLatchPdo] = {kAfterEvent, {cia402::positive_1_position.mapped()}};
    if (forwarded)
      pdos[kLatchPdo].mapping.push_back(cia402::status.mapped());
    else if (axis.model == nullptr || axis.model->times_latches())
      pdos[kLatchPdo].mapping.push_back(cia402::positive_1_time_ns.mapped());
    if (axis.model == nullptr || axis.model->counts_edges())
      pdos[kEdgePdo] = {kAfterEvent,
                        {cia402::positive_1_edge_count.mapped(), cia402::following_error.mapped()}};
  }
  if (axis.way == Way::offset && axis.reports_offset)
    pdos[kOffsetPdo].mapping = {cia402::offset.mapped()};
  return pdos;
}

// One PDO of one device; the records of receive and transmit PDOs lie alike.
struct Record {
  std::uint16_t communication;
  std::uint16_t mapping;
  std::string name;
};

Record record_of(PdoKind kind, std::size_t number) {
  const bool receive = kind == PdoKind::receive;
  const auto n = static_cast<std::uint16_t>(number);
  return {static_cast<std::uint16_t>(
              (receive ? PdoTable::kReceiveCommunication : PdoTable::kTransmitCommunication) + n),
          static_cast<std::uint16_t>(
              (receive ? PdoTable::kReceiveMapping : PdoTable::kTransmitMapping) + n),
          fmt::format("{}PDO{}", receive ? 'R' : 'T', number + 1)};
}

// The order of CiA 301, 7.5.2.36 and 7.5.2.38: off, count 0, entries, count.
void plan_mapping(SetupPlan& plan, const Record& record, const Mapping& mapping) {
  plan_value<std::uint8_t>(plan, {record.mapping, 0}, 0, record.name + " maps nothing");
  std::uint8_t sub = 0;
  for (const std::uint32_t entry : mapping)
    plan_bits<std::uint32_t>(plan, {record.mapping, ++sub}, entry,
                             fmt::format("{} entry {}", record.name, sub));
  plan_value<std::uint8_t>(plan, {record.mapping, 0}, sub, record.name + " entries");
}

// COB-ID of the predefined set; no drive answers remote requests.
std::uint32_t cob_id(PdoKind kind, std::size_t number, std::uint8_t node) {
  const std::uint32_t first = kind == PdoKind::receive ? canopen::kRpdo1 : canopen::kTpdo1;
  const std::uint32_t flags = kind == PdoKind::receive ? 0 : canopen::kPdoNoRtr;
  return flags | static_cast<std::uint32_t>(first + 0x100U * number + node);
}

void plan_pdo(SetupPlan& plan, const BusAxis& axis, PdoKind kind, std::size_t number,
              const WantedPdo& wanted) {
  const Record record = record_of(kind, number);
  const std::uint32_t id = cob_id(kind, number, axis.drive);
  const auto has = [&](std::uint8_t sub) {
    return axis.model == nullptr || axis.model->has({record.communication, sub});
  };
  plan_bits<std::uint32_t>(plan, {record.communication, 1}, id | canopen::kPdoInvalid,
                           record.name + " off");
  plan_value<std::uint8_t>(plan, {record.communication, 2}, wanted.type, record.name + " type");
  if (kind == PdoKind::transmit && has(3))
    plan_value<std::uint16_t>(plan, {record.communication, 3}, 0, record.name + " inhibit time");
  if (kind == PdoKind::transmit && has(5))
    plan_value<std::uint16_t>(plan, {record.communication, 5}, 0, record.name + " event timer");
  plan_mapping(plan, record, wanted.mapping);
  plan_bits<std::uint32_t>(plan, {record.communication, 1}, id, record.name + " on");
}

std::vector<canopen::PdoParameters> defaults_of(const BusAxis& axis, PdoKind kind) {
  if (axis.model != nullptr) return axis.model->eds().pdos(kind, axis.drive);
  if (kind == PdoKind::receive) {
    const auto pdos = cia402_receive_pdos(axis.drive);
    return {pdos.begin(), pdos.end()};
  }
  const auto pdos = cia402_transmit_pdos(axis.drive);
  return {pdos.begin(), pdos.end()};
}

// What the drive does not need is switched off where it is on by default: it listens to frames that
// are not meant for it, or says what nobody asked for.
void plan_pdos(SetupPlan& plan, const BusAxis& axis, PdoKind kind, const WantedPdos& wanted) {
  const std::vector<canopen::PdoParameters> defaults = defaults_of(axis, kind);
  for (std::size_t i = 0; i < std::max(defaults.size(), wanted.size()); ++i) {
    if (i < wanted.size() && !wanted[i].mapping.empty()) {
      plan_pdo(plan, axis, kind, i, wanted[i]);
    } else if (i < defaults.size() && (defaults[i].cob_id & canopen::kPdoInvalid) == 0) {
      const Record record = record_of(kind, i);
      plan_bits<std::uint32_t>(plan, {record.communication, 1},
                               defaults[i].cob_id | canopen::kPdoInvalid, record.name + " off");
    }
  }
}

void plan_heard(SetupPlan& plan, std::size_t number, std::uint32_t id, const Mapping& mapping) {
  const Record record = record_of(PdoKind::receive, number);
  plan_bits<std::uint32_t>(plan, {record.communication, 1}, id | canopen::kPdoInvalid,
                           record.name + " off");
  if (mapping.empty()) return;
  plan_mapping(plan, record, mapping);
  plan_bits<std::uint32_t>(plan, {record.communication, 1}, id, record.name + " on");
}

}  // namespace

SetupPlan drive_plan(const BusSettings& settings, std::size_t axis) {
  const BusAxis& a = settings.axes.at(axis);
  SetupPlan plan = common_plan(settings);
  plan_bits<std::uint32_t>(
      plan, canopen::object::consumer_heartbeat[1].id(),
      std::uint32_t{settings.node} << 16U | settings.heartbeat_timeout_ms,
      fmt::format("{}: compensation node", canopen::object::consumer_heartbeat.name));
  if (a.model == nullptr && a.way == Way::offset) return plan;
  const auto missing = [&](const PlannedValue& value) {
    return a.model != nullptr && !a.model->has(value.object);
  };
  plan.erase(std::remove_if(plan.begin(), plan.end(), missing), plan.end());
  plan_pdos(plan, a, PdoKind::receive, received_by(a.way));
  plan_pdos(plan, a, PdoKind::transmit, sent_by(a, settings.probes));
  return plan;
}

std::vector<std::uint32_t> forwarded_mapping(std::size_t receive_pdo) {
  return received_by(Way::forwarded_target).at(receive_pdo).mapping;
}

SetupPlan heard_plan(const BusSettings& settings, std::size_t axis) {
  namespace object = node::object;
  const BusAxis& a = settings.axes.at(axis);
  SetupPlan plan;
  if (a.model == nullptr || a.way == Way::forwarded_target) return plan;
  const WantedPdos sent = sent_by(a, settings.probes);
  const auto id = [&](std::size_t pdo) {
    return static_cast<std::uint32_t>(canopen::kTpdo1 + 0x100U * pdo + a.drive);
  };
  if (sent[kActualPdo].mapping.size() < 3)
    plan_heard(plan, node::kNodeAxes + axis, id(kActualPdo),
               {object::actual[axis].mapped(), object::drive_status[axis].mapped()});
  if (sent[kLatchPdo].mapping.size() < 2) {
    const Mapping latched =
        sent[kLatchPdo].mapping.empty() ? Mapping{} : Mapping{object::latched[axis].mapped()};
    plan_heard(plan, 3 * node::kNodeAxes + axis, id(kLatchPdo), latched);
  }
  if (sent[kEdgePdo].mapping.empty())
    plan_heard(plan, 4 * node::kNodeAxes + axis, id(kEdgePdo), {});
  return plan;
}

}  // namespace volcomp::host
