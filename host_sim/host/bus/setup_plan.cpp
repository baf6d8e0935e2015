#include "host_sim/host/bus/setup_plan.hpp"

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "firmware/node/node_objects.hpp"
#include "host_sim/host/bus/cia402_status.hpp"
#include "host_sim/host/bus/probe_setup.hpp"
#include "host_sim/host/bus/stroke_setup.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// 1016h (CiA 301, 7.5.2.19): node id in bits 16 to 22, time in ms in the lower half.
std::uint32_t supervision(std::uint8_t node, const BusSettings& b) {
  return std::uint32_t{node} << 16U | b.heartbeat_timeout_ms;
}

std::string heartbeat_name(const std::string& of, std::uint8_t node, const BusSettings& b) {
  return fmt::format("heartbeat of {} (node {}), missed after {} ms", of, node,
                     b.heartbeat_timeout_ms);
}

constexpr std::uint8_t sub_of_axis(std::size_t axis) { return static_cast<std::uint8_t>(axis + 1); }

// Sub-index 1 of 1016h is the controller.
constexpr std::uint8_t sub_of_heartbeat(std::size_t axis) {
  return static_cast<std::uint8_t>(axis + 2);
}

void plan_axis(SetupPlan& plan, const BusSettings& b, std::size_t axis) {
  const BusAxis& a = b.axes[axis];
  const AxisLimits& l = b.limits.axis.at(axis);
  const char* const position = a.rotary ? "2^-40 turn" : "nm";
  const char* const offset = a.rotary ? "2^-32 turn" : "nm";
  const char* const offset_rate = a.rotary ? "2^-32 turn/cycle" : "nm/cycle";
  const auto name = [&a](const char* before, const char* after = "") {
    return fmt::format("{} {}{}", before, a.letter, after);
  };
  plan_bits<std::uint32_t>(plan, {0x1016, sub_of_heartbeat(axis)}, supervision(a.drive, b),
                           heartbeat_name(name("drive"), a.drive, b));
  plan_value(plan, node::object::drive[axis], a.drive, name("node id of the drive of"));
  plan_value(plan, node::object::scale_numerator[axis], a.scale_numerator,
             name("numerator of the drive unit of"), position);
  plan_value(plan, node::object::scale_denominator[axis], a.scale_denominator,
             name("denominator of the drive unit of"));
  plan_value(plan, node::object::rotary[axis], a.rotary ? 1 : 0,
             name("kind of", " (0 linear, 1 rotary)"));
  plan_bits<std::uint16_t>(plan, node::object::homed_mask[axis].id(), kStatusReferenced,
                           name("bits of 6041h of", " that mean referenced"));
  plan_value(plan, node::object::limit[axis], l.limit, name("largest offset of"), offset);
  plan_value(plan, node::object::slew[axis], l.rate, name("fastest change of the offset of"),
             offset_rate);
  plan_value(plan, node::object::soft_rate[axis], l.soft_rate,
             name("gentle change of the offset of"), offset_rate);
  plan_value(plan, node::object::hysteresis[axis], l.hysteresis,
             name("hysteresis of the direction of"), offset);
  plan_value(plan, node::object::max_step[axis], l.max_step,
             name("largest plausible step of", " (0: unchecked)"), position);
}

// CiA 301, 7.5.2.37: the inhibit time may change only while the PDO does not exist.
void plan_status_every_cycle(SetupPlan& plan, const BusSettings& b) {
  constexpr auto kStatus = static_cast<std::uint16_t>(0x1800 + node::kStatusPdo);
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
  canopen::store_le(value.data(), value.size(), bits);
  return value;
}

SetupPlan common_plan(const BusSettings& settings) {
  SetupPlan plan;
  // The counter may change only while there is no period (CiA 301, 7.5.2.22).
  plan_value<std::uint32_t>(plan, {0x1006, 0}, 0, "cycle period, for the next value", "us");
  plan_value<std::uint8_t>(plan, {0x1019, 0}, 240, "SYNC counter overflow");
  plan_value<std::uint32_t>(plan, {0x1006, 0}, settings.period_us, "cycle period", "us");
  plan_value<std::uint16_t>(plan, {0x1017, 0}, settings.heartbeat_ms, "own heartbeat", "ms");
  plan_bits<std::uint32_t>(plan, {0x1016, 1}, supervision(settings.controller, settings),
                           heartbeat_name("the controller", settings.controller, settings));
  return plan;
}

SetupPlan node_plan(const BusSettings& settings) {
  if (settings.axes.size() > node::kNodeAxes)
    throw UserError(fmt::format("a compensation node has {} axes, the machine {}", node::kNodeAxes,
                                settings.axes.size()));
  SetupPlan plan = common_plan(settings);
  plan_value(plan, node::object::machine_id, settings.machine_id, "machine id");
  plan_value(plan, node::object::controller, settings.controller, "node id of the controller");
  plan_value(plan, node::object::position_source, static_cast<std::uint8_t>(settings.limits.source),
             "position source (0 target, 1 actual)");
  plan_value(plan, node::object::ramp_cycles, settings.limits.ramp_ticks, "ramp", "cycles");
  plan_value(plan, node::object::drop_cycles, settings.limits.stale_drop_ticks,
             "missing positions until an offset is dropped", "cycles");
  plan_value(plan, node::object::deadline_us, settings.deadline_us,
             "deadline after SYNC (0: 60 % of the period)", "us");
  if (!settings.drives_report_offsets)
    plan_value(plan, node::object::drives_report, 0, "drives report their offsets");
  for (std::size_t i = 0; i < settings.axes.size(); ++i)
    plan_axis(plan, settings, i);
  if (settings.status_every_cycle) plan_status_every_cycle(plan, settings);
  if (settings.strokes) append(plan, stroke_plan(settings, *settings.strokes));
  return plan;
}

SetupPlan setup_plan(const MachineFile& machine, const BusSettings& settings,
                     const NodeProbe* probe) {
  SetupPlan plan;
  // A node is supervised in one place only (CiA 301, 7.5.2.19): an older set-up with the same
  // drives in another order would refuse the new one.
  for (std::size_t i = 0; i <= node::kNodeAxes; ++i)
    plan_bits<std::uint32_t>(plan, {0x1016, static_cast<std::uint8_t>(i + 1)}, 0,
                             "no heartbeat is awaited");
  for (std::size_t i = settings.axes.size(); i < node::kNodeAxes; ++i)
    plan_value(plan, node::object::drive[i], 0, fmt::format("no drive of axis {}", i + 1));
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
