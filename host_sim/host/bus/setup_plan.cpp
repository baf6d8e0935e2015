#include "host_sim/host/bus/setup_plan.hpp"

#include <array>

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/node_objects.hpp"
#include "host_sim/host/bus/drive_plan.hpp"
#include "host_sim/host/bus/probe_setup.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

namespace stroke = node::object::stroke;

std::uint8_t number_of_axis(const BusSettings& b, char letter) {
  for (std::size_t i = 0; i < b.axes.size(); ++i) {
    if (b.axes[i].letter == letter) return static_cast<std::uint8_t>(i + 1);
  }
  throw UserError(fmt::format("a grinder of helical gears needs an axis {} on the bus", letter));
}

void plan_stroke_grid(SetupPlan& plan, const BusSettings& b, const WatchedStrokes& w) {
  constexpr std::array<char, 3> kAxes{'X', 'Z', 'C'};
  for (std::size_t i = 0; i < kAxes.size(); ++i)
    plan_value(plan, stroke::axis[i], number_of_axis(b, kAxes[i]));
  plan_value(plan, stroke::slots, w.slots);
  plan_value(plan, stroke::nodes, static_cast<std::uint16_t>(w.monitor.nodes));
  plan_value(plan, stroke::pitch_nm, w.monitor.node_pitch_nm);
  plan_value(plan, stroke::first_node_nm, w.monitor.z0_nm);
  plan_value(plan, stroke::rate, w.offsets.rate, "2^-32 turn");
  plan_value(plan, stroke::stale_cycles, static_cast<std::uint16_t>(w.offsets.stale_ticks));
}

void plan_learning(SetupPlan& plan, const WatchedStrokes& w) {
  plan_values(plan, stroke::rules,
              std::array{w.along.weight, w.along.dead_sigma, w.along.most_step, w.along.most_offset,
                         w.along.most_slope, w.around.most_slope});
  plan_values(plan, stroke::least_samples,
              std::array{w.along.least_samples, w.around.least_samples});
  plan_value(plan, stroke::target, static_cast<std::uint8_t>(w.target));
  plan_value(plan, stroke::force, w.target == LearningTarget::synchronisation ? 0 : 1);
}

// 2500h to 2505h: what a node that watches the strokes of a helical grinder needs to know of gear,
// lines and learning. The last value has the node check and adopt them all. Throws UserError when
// X, Z or C is not on the bus.
SetupPlan stroke_plan(const BusSettings& settings, const WatchedStrokes& strokes) {
  const auto& monitor = strokes.monitor;
  SetupPlan plan;
  plan_value(plan, stroke::command, static_cast<std::uint8_t>(node::StrokeCommand::off));
  plan_stroke_grid(plan, settings, strokes);
  plan_values(plan, stroke::gear,
              std::array{monitor.turn_per_mm, monitor.flank_per_rad, monitor.flank_per_x});
  plan_values(plan, stroke::wavelength_mm, monitor.order_wavelength_mm);
  plan_values(plan, stroke::frequency_hz, monitor.time_line_hz);
  plan_learning(plan, strokes);
  plan_value(plan, stroke::command, static_cast<std::uint8_t>(node::StrokeCommand::on));
  return plan;
}

// 1016h (CiA 301, 7.5.2.19): node id in bits 16 to 22, time in ms in the lower half.
std::uint32_t supervision(std::uint8_t node, const BusSettings& b) {
  return std::uint32_t{node} << 16U | b.heartbeat_timeout_ms;
}

std::string heartbeat_name(const std::string& of, std::uint8_t node, const BusSettings& b) {
  return fmt::format("heartbeat of {} (node {}), missed after {} ms", of, node,
                     b.heartbeat_timeout_ms);
}

void plan_axis(SetupPlan& plan, const BusSettings& b, std::size_t axis) {
  const BusAxis& a = b.axes[axis];
  const AxisLimits& l = b.limits.axis.at(axis);
  const char* const position = a.rotary ? "2^-40 turn" : "nm";
  const char* const offset = a.rotary ? "2^-32 turn" : "nm";
  const auto set = [&](const auto& of_axes, auto value, const char* unit = "") {
    plan_value(plan, of_axes[axis], value, unit);
    plan.back().name += fmt::format(" (axis {})", a.letter);
  };
  // The first is the controller.
  plan_bits<std::uint32_t>(plan, node::object::consumer_heartbeat[axis + 1].id(),
                           supervision(a.drive, b),
                           heartbeat_name(fmt::format("drive {}", a.letter), a.drive, b));
  set(node::object::drive, a.drive);
  if (a.way != Way::offset) set(node::object::way, static_cast<std::uint8_t>(a.way));
  set(node::object::scale_numerator, a.scale_numerator, position);
  set(node::object::scale_denominator, a.scale_denominator);
  set(node::object::rotary, static_cast<std::uint8_t>(a.rotary));
  if (a.units_per_turn != 0) set(node::object::units_per_turn, a.units_per_turn);
  set(node::object::homed_mask, a.referenced_mask);
  plan.back().hexadecimal = true;
  if (a.way == Way::offset && !a.reports_offset) set(node::object::confirms, std::uint8_t{0});
  set(node::object::limit, l.limit, offset);
  set(node::object::slew, l.rate, offset);
  set(node::object::soft_rate, l.soft_rate, offset);
  if (l.acceleration != 0) set(node::object::acceleration, l.acceleration, offset);
  set(node::object::hysteresis, l.hysteresis, offset);
  set(node::object::max_step, l.max_step, position);
}

// CiA 301, 7.5.2.37: the inhibit time may change only while the PDO does not exist.
void plan_status_every_cycle(SetupPlan& plan, const BusSettings& b) {
  constexpr auto kStatus =
      static_cast<std::uint16_t>(canopen::PdoTable::kTransmitCommunication + node::kStatusPdo);
  const std::uint32_t id = canopen::kPdoNoRtr | (canopen::kTpdo1 + std::uint32_t{b.node});
  plan_bits<std::uint32_t>(plan, {kStatus, 1}, id | canopen::kPdoInvalid, "status PDO off");
  plan_value<std::uint16_t>(plan, {kStatus, 3}, 0, "inhibit time of the status PDO", "0.1 ms");
  plan_bits<std::uint32_t>(plan, {kStatus, 1}, id, "status PDO on");
}

void append(SetupPlan& plan, const SetupPlan& more) {
  plan.insert(plan.end(), more.begin(), more.end());
}

}  // namespace

SdoChannel::Bytes PlannedValue::bytes() const {
  SdoChannel::Bytes value(canopen::size_of(type));
  store_le(value.data(), value.size(), bits);
  return value;
}

SetupPlan common_plan(const BusSettings& settings) {
  SetupPlan plan;
  // The counter may change only while there is no period (CiA 301, 7.5.2.22).
  plan_value(plan, node::object::cycle_period_us, 0, "us");
  plan.back().name += ", for the next value";
  plan_value(plan, node::object::sync_counter_overflow, sync_counter_overflow(settings));
  plan_value(plan, node::object::cycle_period_us, settings.period_us, "us");
  plan_value(plan, node::object::producer_heartbeat_ms, settings.heartbeat_ms, "ms");
  plan_bits<std::uint32_t>(plan, node::object::consumer_heartbeat.id(),
                           supervision(settings.controller, settings),
                           heartbeat_name("the controller", settings.controller, settings));
  return plan;
}

SetupPlan node_plan(const BusSettings& settings) {
  if (settings.axes.size() > node::kNodeAxes)
    throw UserError(fmt::format("a compensation node has {} axes, the machine {}", node::kNodeAxes,
                                settings.axes.size()));
  SetupPlan plan = common_plan(settings);
  plan_value(plan, node::object::machine_id, settings.machine_id);
  plan_value(plan, node::object::controller, settings.controller);
  plan_value(plan, node::object::position_source,
             static_cast<std::uint8_t>(settings.limits.source));
  plan_value(plan, node::object::ramp_cycles, settings.limits.ramp_ticks);
  plan_value(plan, node::object::drop_cycles, settings.limits.stale_drop_ticks);
  plan_value(plan, node::object::deadline_us, settings.deadline_us);
  for (std::size_t i = 0; i < settings.axes.size(); ++i)
    plan_axis(plan, settings, i);
  for (std::size_t i = 0; i < settings.axes.size(); ++i)
    append(plan, heard_plan(settings, i));
  if (forwards_targets(settings)) {
    // A heartbeat of the controller that is only late must not stop an axis.
    plan_value(plan, node::object::error_behaviour,
               static_cast<std::uint8_t>(canopen::ErrorBehaviour::no_change));
  }
  if (settings.status_every_cycle || counts_on_node(settings))
    plan_status_every_cycle(plan, settings);
  if (settings.strokes) append(plan, stroke_plan(settings, *settings.strokes));
  return plan;
}

SetupPlan setup_plan(const MachineFile& machine, const BusSettings& settings,
                     const NodeProbe* probe) {
  SetupPlan plan;
  // A node is supervised in one place only (CiA 301, 7.5.2.19): an older set-up with the same
  // drives in another order would refuse the new one.
  for (std::size_t i = 0; i <= node::kNodeAxes; ++i)
    plan_bits<std::uint32_t>(plan, node::object::consumer_heartbeat[i].id(), 0,
                             "no heartbeat is awaited");
  for (std::size_t i = settings.axes.size(); i < node::kNodeAxes; ++i) {
    plan_value(plan, node::object::drive[i], 0);
    plan.back().name += fmt::format(" (no axis {})", i + 1);
  }
  // An earlier set-up may have said otherwise.
  for (std::size_t i = 0; i < node::kNodeAxes; ++i) {
    plan_value(plan, node::object::way[i], 0);
    plan_value(plan, node::object::units_per_turn[i], 0);
    plan_value(plan, node::object::acceleration[i], 0);
  }
  plan_value(plan, node::object::drives_report, 1);
  append(plan, node_plan(settings));
  if (probe != nullptr)
    append(plan, probe_plan(*probe));
  else if (machine.probe)
    append(plan, probe_plan(node_probe(machine)));
  return plan;
}

void queue_plan(SdoChannel& channel, const SetupPlan& plan) {
  for (const PlannedValue& value : plan)
    channel.write(value.object, value.bytes(), value.name);
}

}  // namespace volcomp::host
