#include "host_sim/host/bus/device_files/signal_names.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "comp/tick/touch.hpp"
#include "firmware/canopen/emergency.hpp"
#include "firmware/canopen/nmt.hpp"
#include "firmware/node/object_handles.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"

namespace volcomp::host {
namespace {

namespace object = node::object;

template <class Enum>
std::pair<unsigned, std::string> named(Enum value, const char* name) {
  return {static_cast<unsigned>(value), name};
}

// Bits of StatusBit.
constexpr const char* kStatusBitNames =
    "Bits: 0 valid, 1 not homed, 2 stale, 3 dropped, 4 implausible, 5 out of range, 6 far out of "
    "range, 7 clamped, 8 rate limited, 9 direction unknown, 10 ramping, 11 no authority, 12 no "
    "tables, 13 table damaged";

const std::vector<SignalText>& texts() {
  static const std::vector<SignalText> all{
      {{0x6040, 0}, "Controlword", Quantity::code},
      {{0x6041, 0}, "Statusword", Quantity::code},
      {{0x6064, 0}, "ActualPosition", Quantity::position},
      {{0x607A, 0}, "TargetPosition", Quantity::position},
      {{0x60B0, 0}, "PositionOffset", Quantity::position},
      {{0x60B9, 0}, "ProbeStatus", Quantity::code},
      {{0x60BA, 0}, "ProbePosition", Quantity::position},
      {{0x60D1, 0}, "ProbeTime", Quantity::time, "Since the last SYNC"},
      {{0x60D5, 0}, "EdgeCounter", Quantity::count},
      {{0x60F4, 0}, "FollowingError", Quantity::position},
      {object::stroke::slot.id(), "Slot", Quantity::count, "From 0"},
      {object::stroke::flags.id(), "StrokeFlags", Quantity::code,
       "Bits: 0 in the face, 1 end of a stroke, 2 forward, 3 backward"},
      {object::stroke::feed_nm_per_s.id(), "StrokeFeed", Quantity::speed, "Programmed, magnitude"},
      {object::active_crc.id(), "ActiveCrc", Quantity::code},
      {object::probe::sequence.id(), "PointNumber", Quantity::count},
      {object::probe::verdict.id(), "Verdict", Quantity::code, nullptr, touch_verdicts()},
      {object::probe::axis.id(), "VerdictAxis", Quantity::code, "From 1; 0: none in particular"},
      {object::probe::feature_low.id(), "Feature", Quantity::code, "Low half of 2310h:01"},
      {object::probe::workpiece_nm.id(), "PointX", Quantity::position},
      {object::probe::workpiece_nm[1].id(), "PointY", Quantity::position},
      {object::probe::workpiece_nm[2].id(), "PointZ", Quantity::position},
      {object::probe::uncertainty_nm.id(), "PointUncertainty", Quantity::position,
       "Largest of the three coordinates"},
      {object::state.id(), "NodeState", Quantity::code, nullptr, node_states()},
      {object::sync_counter.id(), "SyncCounter", Quantity::count},
      {object::any_status.id(), "AxisStatusBits", Quantity::code, kStatusBitNames},
      {object::thermal::reading.id(), "Temperature0", Quantity::temperature},
      {object::thermal::reading[1].id(), "Temperature1", Quantity::temperature},
      {object::thermal::reading[2].id(), "Temperature2", Quantity::temperature},
      {object::thermal::reading[3].id(), "Temperature3", Quantity::temperature}};
  return all;
}

}  // namespace

const SignalText& signal_text(canopen::ObjectId object) {
  const auto& all = texts();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [object](const SignalText& t) { return t.object == object; });
  if (found != all.end()) return *found;
  throw std::logic_error(
      fmt::format("object {:04X}h:{:02X} has no signal name", object.index, object.sub));
}

ValueNames nmt_states() {
  using canopen::NmtState;
  return {named(NmtState::boot_up, "boot-up"), named(NmtState::stopped, "stopped"),
          named(NmtState::operational, "operational"),
          named(NmtState::pre_operational, "pre-operational")};
}

ValueNames nmt_commands() {
  using canopen::NmtCommand;
  return {named(NmtCommand::start, "start"), named(NmtCommand::stop, "stop"),
          named(NmtCommand::enter_pre_operational, "enter pre-operational"),
          named(NmtCommand::reset_node, "reset node"),
          named(NmtCommand::reset_communication, "reset communication")};
}

ValueNames node_states() {
  using node::NodeState;
  return {named(NodeState::idle, "idle"),
          named(NodeState::no_tables, "no tables"),
          named(NodeState::waiting, "waiting for drives"),
          named(NodeState::compensating, "compensating"),
          named(NodeState::degraded, "degraded"),
          named(NodeState::overdue, "background overdue")};
}

ValueNames touch_verdicts() {
  ValueNames names;
  for (std::uint8_t v = 0; v < kTouchVerdicts; ++v)
    names.emplace_back(v, code(static_cast<TouchVerdict>(v)));
  return names;
}

ValueNames error_codes() {
  using canopen::ErrorCode;
  return {named(ErrorCode::none, "error gone"),
          named(ErrorCode::temperature_held, "temperature missing or implausible"),
          named(ErrorCode::memory_damaged, "settings damaged"),
          named(ErrorCode::program_damaged, "program damaged"),
          named(ErrorCode::store_failed, "saving failed"),
          named(ErrorCode::unexpected_reset, "restarted by watchdog or fault"),
          named(ErrorCode::background_overdue, "background hangs"),
          named(ErrorCode::parameters_lost, "stored parameters damaged"),
          named(kCommunicationErrorCode, "communication"),
          named(ErrorCode::can_overrun, "frames lost"),
          named(ErrorCode::can_passive, "CAN controller error passive"),
          named(ErrorCode::heartbeat, "a node fell silent"),
          named(ErrorCode::bus_off_recovered, "back from bus-off"),
          named(ErrorCode::rpdo_length, "PDO too short"),
          named(ErrorCode::sync_length, "SYNC with wrong length"),
          named(ErrorCode::rpdo_timeout, "process data missing"),
          named(kFollowingErrorCode, "following error"),
          named(ErrorCode::axis_not_referenced, "axis not referenced or not enabled"),
          named(ErrorCode::axis_implausible, "position jumped"),
          named(ErrorCode::axis_clamped, "correction limited"),
          named(ErrorCode::axis_out_of_range, "position beyond the table"),
          named(ErrorCode::no_authority, "correcting axes cannot act here"),
          named(ErrorCode::table_refused, "table refused"),
          named(ErrorCode::table_damaged, "active tables damaged"),
          named(ErrorCode::tables_expired, "active tables past their expiry"),
          named(ErrorCode::time_doubted, "TIME jumped"),
          named(ErrorCode::foreign_sync, "second SYNC producer"),
          named(ErrorCode::offset_not_confirmed, "drive does not report its offset"),
          named(ErrorCode::touch_rejected, "touch rejected"),
          named(ErrorCode::point_lost, "probed point lost")};
}

}  // namespace volcomp::host
