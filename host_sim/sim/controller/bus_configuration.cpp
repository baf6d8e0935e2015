// What the motion controller writes into drives and node before it starts them.

#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "comp/core/crc32.hpp"
#include "comp/core/units.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/node_objects.hpp"
#include "host_sim/host/io/user_error.hpp"
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

// Every rising edge is latched; position and instant, then count and following error, go out at the
// SYNC after it and at no other.
void arm_probe(host::SdoChannel& sdo, std::uint8_t drive) {
  constexpr std::uint16_t kRisingContinuously = 0x0013;
  constexpr std::uint8_t kAtNextSync = 0;
  const auto report = [&sdo](std::uint16_t pdo, std::uint32_t id, const std::string& name) {
    sdo.write_value<std::uint32_t>({pdo, 1}, id | canopen::kPdoInvalid, name + " off");
    sdo.write_value<std::uint8_t>({pdo, 2}, kAtNextSync, name + " type");
    sdo.write_value<std::uint32_t>({pdo, 1}, id, name + " on");
  };
  const std::uint32_t base = canopen::kPdoNoRtr | drive;
  report(0x1801, base | canopen::kTpdo2, "latch PDO");
  report(0x1802, base | canopen::kTpdo3, "edge counter PDO");
  sdo.write_value<std::uint16_t>({0x60B8, 0}, 0, "touch probe off");
  sdo.write_value<std::uint16_t>({0x60B8, 0}, kRisingContinuously, "touch probe function");
}

void write_real(host::SdoChannel& sdo, std::uint16_t index, std::size_t sub, double value,
                const std::string& what) {
  std::uint64_t raw = 0;
  std::memcpy(&raw, &value, sizeof raw);
  sdo.write_value<std::uint64_t>({index, static_cast<std::uint8_t>(sub)}, raw, what);
}

template <class Values>
void write_reals(host::SdoChannel& sdo, std::uint16_t index, const Values& values,
                 const std::string& what) {
  for (std::size_t i = 0; i < values.size(); ++i)
    write_real(sdo, index, i + 1, values[i], what);
}

std::uint8_t axis_number(const host::BusSettings& b, char letter) {
  for (std::size_t i = 0; i < b.axes.size(); ++i) {
    if (b.axes[i].letter == letter) return static_cast<std::uint8_t>(i + 1);
  }
  throw host::UserError(
      fmt::format("a grinder of helical gears needs an axis {} on the bus", letter));
}

// 2500h…2505h and what it learns from; the last write takes them over.
void watch_strokes(host::SdoChannel& sdo, const host::BusSettings& b,
                   const host::WatchedStrokes& w) {
  sdo.write_value<std::uint8_t>({0x2500, 1}, static_cast<std::uint8_t>(node::StrokeCommand::off),
                                "strokes off");
  constexpr std::array<char, 3> kAxes{'X', 'Z', 'C'};
  for (std::size_t i = 0; i < kAxes.size(); ++i)
    sdo.write_value<std::uint8_t>({0x2500, static_cast<std::uint8_t>(i + 2)},
                                  axis_number(b, kAxes[i]), "axis of the grinder");
  sdo.write_value<std::uint16_t>({0x2500, 5}, w.slots, "slots");
  sdo.write_value<std::uint16_t>({0x2500, 6}, static_cast<std::uint16_t>(w.monitor.nodes),
                                 "nodes along the stroke");
  sdo.write_value<std::uint32_t>({0x2500, 7}, w.monitor.node_pitch_nm, "distance of the nodes");
  sdo.write_value<std::int64_t>({0x2500, 8}, w.monitor.z0_nm, "first node");
  sdo.write_value<std::int32_t>({0x2500, 9}, w.offsets.rate, "rate of the learned offset");
  sdo.write_value<std::uint16_t>({0x2500, 10}, static_cast<std::uint16_t>(w.offsets.stale_ticks),
                                 "cycles until the learned offset is dropped");
  write_reals(
      sdo, 0x2501,
      std::array<double, 3>{w.monitor.turn_per_mm, w.monitor.flank_per_rad, w.monitor.flank_per_x},
      "helical gear");
  write_reals(sdo, 0x2502, w.monitor.order_wavelength_mm, "wavelength of a line");
  write_reals(sdo, 0x2503, w.monitor.time_line_hz, "frequency of a line");
  write_reals(sdo, 0x2504,
              std::array<double, 6>{w.along.weight, w.along.dead_sigma, w.along.most_step,
                                    w.along.most_offset, w.along.most_slope, w.around.most_slope},
              "learning rules");
  sdo.write_value<std::uint32_t>({0x2505, 1}, w.along.least_samples, "least samples of a node");
  sdo.write_value<std::uint32_t>({0x2505, 2}, w.around.least_samples, "least samples of a slot");
  sdo.write_value<std::uint8_t>({0x2520, 2}, static_cast<std::uint8_t>(w.target),
                                "what is learned from");
  sdo.write_value<std::uint8_t>({0x2520, 3}, w.target == LearningTarget::synchronisation ? 0 : 1,
                                "learning forced");
  sdo.write_value<std::uint8_t>({0x2500, 1}, static_cast<std::uint8_t>(node::StrokeCommand::on),
                                "strokes on");
}

}  // namespace

void BusController::configure(Station& s) {
  s.phase = Station::Phase::configuring;
  s.refused = false;
  s.not_started = 0;
  s.retry_us = 0;
  s.channel.clear();
  if (s.state == canopen::NmtState::operational)
    command(canopen::NmtCommand::enter_pre_operational, s.id);
  configure_common(s.channel);
  if (!is_drive(s)) {
    configure_node(s.channel);
    return;
  }
  const auto axis = static_cast<std::size_t>(&s - stations_.data());
  axis_[axis].drive_lost();
  configure_drive(s, axis);
}

// Heartbeats both ways and the SYNC they all share.
void BusController::configure_common(host::SdoChannel& sdo) {
  const auto watch = [this](std::uint8_t node) {
    return std::uint32_t{node} << 16U | settings_.heartbeat_timeout_ms;
  };
  // The counter may change only while there is no period (CiA 301, 7.5.2.22).
  sdo.write_value<std::uint32_t>({0x1006, 0}, 0, "cycle period");
  sdo.write_value<std::uint8_t>({0x1019, 0}, 240, "SYNC counter overflow");
  sdo.write_value<std::uint32_t>({0x1006, 0}, settings_.period_us, "cycle period");
  sdo.write_value<std::uint16_t>({0x1017, 0}, settings_.heartbeat_ms, "heartbeat time");
  sdo.write_value<std::uint32_t>({0x1016, 1}, watch(settings_.controller),
                                 "heartbeat of the controller");
}

// The drive's own idea of its units against the machine file: 60A8h for a linear axis, position
// units per revolution (6092h through the gear 6091h) for a rotary one.
void BusController::check_scaling(Station& s, std::size_t axis) {
  const host::BusAxis& a = settings_.axes[axis];
  const auto differ = [&s, letter = a.letter](const std::string& what) {
    s.refused = true;
    s.refusal = fmt::format("{}: axis {} has other units than the machine file says: {}", s.name,
                            letter, what);
  };
  if (!a.rotary) {
    s.channel.read({0x60A8, 0}, 4, "position unit",
                   [a, differ](const host::SdoChannel::Bytes& unit) {
                     if (!may_count_in(static_cast<std::uint32_t>(host::number(unit)), a))
                       differ(fmt::format("60A8h is {:08X}h", host::number(unit)));
                   });
    return;
  }
  auto ratio = std::make_shared<std::array<double, 4>>();
  const std::array<canopen::ObjectId, 4> objects{
      {{0x6091, 1}, {0x6091, 2}, {0x6092, 1}, {0x6092, 2}}};
  for (std::size_t i = 0; i < objects.size(); ++i) {
    s.channel.read(objects[i], 4, "gear and feed",
                   [a, differ, ratio, i](const host::SdoChannel::Bytes& v) {
                     (*ratio)[i] = static_cast<double>(host::number(v));
                     if (i + 1 < ratio->size()) return;
                     // 6092h counts position units per revolution of the shaft, which is the axis.
                     const double per_turn = (*ratio)[2] / (*ratio)[3];
                     const double expected = static_cast<double>(kUnitsPerTurn) *
                                             static_cast<double>(a.scale_denominator) /
                                             static_cast<double>(a.scale_numerator);
                     if (std::abs(per_turn - expected) > 0.5)
                       differ(fmt::format("{:.0f} units per turn", per_turn));
                   });
  }
}

void BusController::configure_drive(Station& s, std::size_t axis) {
  const host::BusAxis& a = settings_.axes[axis];
  host::SdoChannel& sdo = s.channel;
  check_scaling(s, axis);
  sdo.write_value<std::uint32_t>(
      {0x1016, 2}, std::uint32_t{settings_.node} << 16U | settings_.heartbeat_timeout_ms,
      "heartbeat of the compensation node");
  if (a.lowest != a.highest) {
    sdo.write_value<std::uint32_t>({0x607D, 1}, static_cast<std::uint32_t>(a.lowest),
                                   "lower software limit");
    sdo.write_value<std::uint32_t>({0x607D, 2}, static_cast<std::uint32_t>(a.highest),
                                   "upper software limit");
  }
  set_mode(sdo, axis, kHomingMode);
  if (settings_.probes) arm_probe(sdo, a.drive);
}

void BusController::configure_node(host::SdoChannel& sdo) {
  const host::BusSettings& b = settings_;
  sdo.write_value<std::uint32_t>({0x2000, 1}, b.machine_id, "machine id");
  sdo.write_value<std::uint8_t>({0x2000, 2}, b.controller, "controller");
  sdo.write_value<std::uint8_t>({0x2000, 3}, static_cast<std::uint8_t>(b.limits.source),
                                "position source");
  sdo.write_value<std::uint32_t>({0x2200, 1}, b.limits.ramp_ticks, "ramp");
  sdo.write_value<std::uint16_t>({0x2200, 2}, b.limits.stale_drop_ticks, "cycles until dropped");
  sdo.write_value<std::uint32_t>({0x2200, 3}, b.deadline_us, "deadline");
  for (std::size_t i = 0; i < b.axes.size(); ++i) {
    const host::BusAxis& a = b.axes[i];
    const AxisLimits& l = b.limits.axis[i];
    const auto sub = static_cast<std::uint8_t>(i + 1);
    const auto heartbeat = static_cast<std::uint8_t>(i + 2);
    sdo.write_value<std::uint32_t>({0x1016, heartbeat},
                                   std::uint32_t{a.drive} << 16U | b.heartbeat_timeout_ms,
                                   "heartbeat of a drive");
    sdo.write_value<std::uint8_t>({0x2010, sub}, a.drive, "drive of an axis");
    sdo.write_value<std::uint32_t>({0x2030, sub}, a.scale_numerator, "scale numerator");
    sdo.write_value<std::uint32_t>({0x2031, sub}, a.scale_denominator, "scale denominator");
    sdo.write_value<std::uint8_t>({0x2032, sub}, a.rotary ? 1 : 0, "kind of axis");
    sdo.write_value<std::uint16_t>({0x2033, sub}, kReferencedBit, "referenced bit");
    sdo.write_value<std::int32_t>({0x2201, sub}, l.limit, "limit");
    sdo.write_value<std::int32_t>({0x2202, sub}, l.rate, "slew limit");
    sdo.write_value<std::int32_t>({0x2203, sub}, l.soft_rate, "soft rate");
    sdo.write_value<std::int32_t>({0x2204, sub}, l.hysteresis, "hysteresis");
    sdo.write_value<std::int64_t>({0x2205, sub}, l.max_step, "largest plausible step");
  }
  if (b.status_every_cycle) {
    constexpr auto kStatus = static_cast<std::uint16_t>(0x1800 + node::kStatusPdo);
    const std::uint32_t id = canopen::kPdoNoRtr | (canopen::kTpdo1 + std::uint32_t{b.node});
    sdo.write_value<std::uint32_t>({kStatus, 1}, id | canopen::kPdoInvalid, "status PDO off");
    sdo.write_value<std::uint16_t>({kStatus, 3}, 0, "status PDO without inhibit time");
    sdo.write_value<std::uint32_t>({kStatus, 1}, id, "status PDO on");
  }
  if (b.strokes) watch_strokes(sdo, b, *b.strokes);
  if (node_probe_) queue_probe(sdo, *node_probe_);
  if (!image_.empty()) queue_tables(sdo);
}

// What the other side has answered. Of tables the node says more than an abort code (2112h:06);
// what it said of them before stays until then.
void BusController::take_refusal(Station& s) {
  const host::SdoChannel& sdo = s.channel;
  const std::string what = sdo.failure();
  if (s.refusal.rfind(what, 0) != 0) s.refusal = what;
  if (is_drive(s) || sdo.failed() != node::kTableCommand || sdo.abort_code() != AbortCode::general)
    return;
  s.channel.clear();
  s.channel.read(node::table_verdict(6), node::kMostReasonText, "reason in words",
                 [&s, what](const host::SdoChannel::Bytes& text) {
                   s.refusal = what + ": " + std::string(text.begin(), text.end());
                 });
}

// Asks first: a node that has them stored or kept them need not get them again.
void BusController::queue_tables(host::SdoChannel& sdo) {
  sdo.read(node::table_verdict(7), 4, "CRC of the active tables",
           [this, &sdo](const host::SdoChannel::Bytes& crc) {
             if (host::number(crc) == image_crc_) return;
             sdo.write(node::kTableImage, image_, "table image");
             sdo.write_value<std::uint8_t>(node::kTableCommand,
                                           static_cast<std::uint8_t>(node::TableCommand::activate),
                                           "activation of the tables");
           });
}

}  // namespace volcomp::sim
