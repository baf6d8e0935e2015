// What the motion controller writes into drives and node before it starts them: into the node what
// `volcomp setup` writes.

#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "comp/core/crc32.hpp"
#include "comp/core/units.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/object_handles.hpp"
#include "firmware/node/wire_scale.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"
#include "host_sim/host/bus/drive_model.hpp"
#include "host_sim/host/bus/drive_plan.hpp"
#include "host_sim/host/bus/setup_plan.hpp"
#include "host_sim/sim/controller/bus_controller.hpp"

namespace volcomp::sim {

using canopen::AbortCode;

namespace {

// Whether a drive with this 60A8h may count so many nanometres per unit: in metres by a power of
// ten it must be just those, in increments any but one nanometre.
bool may_count_in(std::uint32_t unit, const host::BusAxis& axis) {
  constexpr std::uint32_t kMetre = 0x01;
  const double nm = static_cast<double>(axis.scale_numerator) / axis.scale_denominator;
  if ((unit >> 16U & 0xFFU) != kMetre) return axis.scale_numerator != axis.scale_denominator;
  const auto prefix = static_cast<std::int8_t>(unit >> 24U);
  return std::abs(nm / std::pow(10.0, prefix + 9) - 1.0) < 1e-12;
}

// Position and instant, then count and following error, go out at the SYNC after an edge and at no
// other.
void set_latch_pdos(host::SdoChannel& sdo, std::uint8_t drive) {
  constexpr std::uint8_t kAtNextSync = 0;
  const auto report = [&sdo](std::size_t number, std::uint32_t id, const std::string& name) {
    const auto pdo = static_cast<std::uint16_t>(canopen::PdoTable::kTransmitCommunication + number);
    sdo.write_value<std::uint32_t>({pdo, 1}, id | canopen::kPdoInvalid, name + " off");
    sdo.write_value<std::uint8_t>({pdo, 2}, kAtNextSync, name + " type");
    sdo.write_value<std::uint32_t>({pdo, 1}, id, name + " on");
  };
  const std::uint32_t base = canopen::kPdoNoRtr | drive;
  report(host::kLatchPdo, base | canopen::kTpdo2, "latch PDO");
  report(host::kEdgePdo, base | canopen::kTpdo3, "edge counter PDO");
}

constexpr std::uint16_t kRisingContinuously = 0x0013;
constexpr std::uint16_t kRisingOnce = 0x0011;

void arm_probe(host::SdoChannel& sdo, std::uint16_t function) {
  sdo.write(host::cia402::function, 0);
  sdo.write(host::cia402::function, function);
}

}  // namespace

void BusController::configure(Station& s) {
  s.phase = Station::Phase::configuring;
  s.refused = false;
  s.confirmed = false;
  if (!is_drive(s)) {
    for (Station& drive : stations_)
      drive.confirmed = false;
  }
  s.not_started = 0;
  s.retry_us = 0;
  s.channel.clear();
  if (s.state == canopen::NmtState::operational)
    command(canopen::NmtCommand::enter_pre_operational, s.id);
  if (!is_drive(s)) {
    configure_node(s.channel);
    return;
  }
  const auto axis = static_cast<std::size_t>(&s - stations_.data());
  axis_[axis].drive_lost();
  configure_drive(s, axis);
}

// Checks the units of the drive against the machine file: 60A8h for a linear axis, position units
// per revolution (6092h through the gear 6091h) for a rotary one. A drive may have neither.
void BusController::check_scaling(Station& s, std::size_t axis) {
  const host::BusAxis& a = settings_.axes[axis];
  if (a.model != nullptr &&
      !a.model->has(a.rotary ? host::cia402::feed.id() : host::cia402::position_unit.id()))
    return;
  const auto differ = [&s, letter = a.letter](const std::string& what) {
    s.refused = true;
    s.refusal = fmt::format("{}: axis {} has other units than the machine file says: {}", s.name,
                            letter, what);
  };
  if (!a.rotary) {
    s.channel.read(host::cia402::position_unit, [a, differ](std::uint32_t unit) {
      if (!may_count_in(unit, a)) differ(fmt::format("60A8h is {:08X}h", unit));
    });
    return;
  }
  auto ratio = std::make_shared<std::array<double, 4>>();
  const auto& gear = host::cia402::gear;
  const auto& feed = host::cia402::feed;
  const std::array objects{gear[0], gear[1], feed[0], feed[1]};
  for (std::size_t i = 0; i < objects.size(); ++i) {
    s.channel.read(objects[i], [a, differ, ratio, i](std::uint32_t value) {
      (*ratio)[i] = value;
      if (i + 1 < ratio->size()) return;
      // 6092h counts position units per revolution of the shaft, which is the axis.
      const double per_turn = (*ratio)[2] / (*ratio)[3];
      const double expected = static_cast<double>(kUnitsPerTurn) / host::unit_size(a);
      if (std::abs(per_turn - expected) > 0.5)
        differ(fmt::format("{:.0f} units per turn", per_turn));
    });
  }
}

void BusController::configure_drive(Station& s, std::size_t axis) {
  const host::BusAxis& a = settings_.axes[axis];
  host::SdoChannel& sdo = s.channel;
  host::queue_plan(sdo, host::drive_plan(settings_, axis));
  check_scaling(s, axis);
  if (a.lowest != a.highest) {
    sdo.write(host::cia402::software_limit[0], a.lowest);
    sdo.write(host::cia402::software_limit[1], a.highest);
  }
  set_mode(sdo, axis, kHomingMode);
  if (!settings_.probes) return;
  if (a.model == nullptr) set_latch_pdos(sdo, a.drive);
  arm_probe(sdo, latches_once(axis) ? kRisingOnce : kRisingContinuously);
}

// A drive that does not count its edges tells one by the rise of a bit in 60B9h: it must fall
// before the next.
bool BusController::latches_once(std::size_t axis) const {
  const host::DriveModel* const model = settings_.axes[axis].model.get();
  return settings_.probes && model != nullptr && !model->counts_edges();
}

// Contacts bounce: the next edge is awaited a while after the last.
void BusController::arm_again() {
  constexpr std::uint16_t kStored = 1U << 1U;  // of 60B9h
  constexpr int kAfterBounces = 10;            // cycles
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    host::SdoChannel& sdo = stations_[a].channel;
    const bool stored = latches_once(a) && (probe_[a].status & kStored) != 0;
    probe_[a].stored_cycles = stored ? probe_[a].stored_cycles + 1 : 0;
    if (probe_[a].stored_cycles < kAfterBounces || !sdo.idle()) continue;
    probe_[a].stored_cycles = 0;
    arm_probe(sdo, kRisingOnce);
  }
}

void BusController::configure_node(host::SdoChannel& sdo) {
  host::queue_plan(sdo, host::node_plan(settings_));
  if (node_probe_) host::queue_plan(sdo, host::probe_plan(*node_probe_));
  if (!image_.empty()) queue_tables(sdo);
}

// A drive that cannot report its offset is asked for it over SDO, and the node told (2206h): it
// sends nothing before. Drives without a data sheet leave that to whoever knows them.
void BusController::tell_held_offset(std::size_t axis) {
  const host::BusAxis& a = settings_.axes[axis];
  Station& drive = stations_[axis];
  Station& node = stations_.back();
  if (drive.phase != Station::Phase::running || node.phase != Station::Phase::running) return;
  const node::WireScale scale = host::wire_scale(a);
  if (a.way == host::Way::controller_adds) {
    node.channel.write(node::object::start_offset[axis],
                       node::offset_from_wire(added_[axis], scale));
    return;
  }
  if (a.model == nullptr || a.reports_offset || a.way != host::Way::offset) return;
  drive.channel.read(host::cia402::offset, [&node, axis, scale](std::int32_t wire) {
    node.channel.write(node::object::start_offset[axis], node::offset_from_wire(wire, scale));
  });
}

// What the drive has mapped is read back; only then the node is told that its targets are what the
// drive takes on 300h + n (2037h).
void BusController::confirm_mapping(std::size_t axis) {
  Station& drive = stations_[axis];
  Station& node = stations_.back();
  const bool ready = drive.phase == Station::Phase::running &&
                     drive.state == canopen::NmtState::operational &&
                     node.phase == Station::Phase::running;
  if (settings_.axes[axis].way != host::Way::forwarded_target || drive.confirmed || !ready) return;
  drive.confirmed = true;
  auto right = std::make_shared<bool>(true);
  const auto expect = [&drive, right](canopen::ObjectId object, std::size_t bytes,
                                      std::uint32_t value) {
    drive.channel.read(object, bytes, "mapping", [right, value](const host::SdoChannel::Bytes& b) {
      *right = *right && load_le(b.data(), b.size()) == value;
    });
  };
  for (const std::size_t pdo : {std::size_t{0}, std::size_t{1}}) {
    const std::vector<std::uint32_t> mapping = host::forwarded_mapping(pdo);
    const auto index = static_cast<std::uint16_t>(canopen::PdoTable::kReceiveMapping + pdo);
    expect({index, 0}, 1, static_cast<std::uint32_t>(mapping.size()));
    for (std::size_t i = 0; i < mapping.size(); ++i)
      expect({index, static_cast<std::uint8_t>(i + 1)}, 4, mapping[i]);
  }
  drive.channel.read(host::cia402::statusword, [&node, axis, right](std::uint16_t) {
    if (*right)
      node.channel.write(node::object::mapped_way[axis],
                         static_cast<std::uint8_t>(host::Way::forwarded_target));
  });
}

// Once a drive or the node runs: of that drive, or of all of them.
void BusController::tell_held_offsets(const Station& started) {
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    if (!is_drive(started) || &started == &stations_[a]) tell_held_offset(a);
  }
}

// Takes the reason of a refusal. For tables the node gives more than an abort code (2112h:06); an
// earlier reason stays until that has been read.
void BusController::take_refusal(Station& s) {
  const host::SdoChannel& sdo = s.channel;
  const std::string what = sdo.failure();
  if (s.refusal.rfind(what, 0) != 0) s.refusal = what;
  if (is_drive(s) || sdo.failed() != node::object::table_command.id() ||
      sdo.abort_code() != AbortCode::general)
    return;
  s.channel.clear();
  s.channel.read(node::object::reason_text,
                 [&s, what](const std::string& text) { s.refusal = what + ": " + text; });
}

// Reads the CRC first: a node that has stored or kept these tables does not get them again.
void BusController::queue_tables(host::SdoChannel& sdo) {
  sdo.read(node::object::active_crc, [this, &sdo](std::uint32_t crc) {
    if (crc == image_crc_) return;
    sdo.write(node::object::image.id(), image_, "table image");
    sdo.write_value<std::uint8_t>(node::object::table_command.id(),
                                  static_cast<std::uint8_t>(node::TableCommand::activate),
                                  "activation of the tables");
  });
}

}  // namespace volcomp::sim
