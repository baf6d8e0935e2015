#include "host_sim/host/bus/device_files/signal_names.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "comp/tick/status_text.hpp"
#include "comp/tick/touch.hpp"
#include "firmware/canopen/emergency.hpp"
#include "firmware/canopen/nmt.hpp"
#include "firmware/node/object_handles.hpp"
#include "firmware/node/ways.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"

namespace volcomp::host {
namespace {

namespace object = node::object;

template <class Enum>
std::pair<unsigned, std::string> named(Enum value, const char* name) {
  return {static_cast<unsigned>(value), name};
}

// "Bits: 0 valid, 1 not homed, … 15 a forwarded axis is not served"
std::string name_status_bits() {
  std::string names;
  for (unsigned bit = 0; bit < kStatusBits; ++bit)
    names += fmt::format("{} {} {}", bit == 0 ? "Bits:" : ",", bit,
                         code(static_cast<StatusBit>(1U << bit)));
  std::replace(names.begin(), names.end(), '_', ' ');
  constexpr auto kNotServed = static_cast<unsigned>(__builtin_ctz(node::kForwardingIncomplete));
  return names + fmt::format(", {} a forwarded axis is not served", kNotServed);
}

const std::vector<SignalText>& texts() {
  static const std::string status_bits = name_status_bits();
  static const std::vector<SignalText> all{
      {cia402::controlword.id(), "Controlword", Quantity::code},
      {cia402::statusword.id(), "Statusword", Quantity::code},
      {cia402::actual.id(), "ActualPosition", Quantity::position},
      {cia402::target.id(), "TargetPosition", Quantity::position},
      {cia402::offset.id(), "PositionOffset", Quantity::position},
      {cia402::status.id(), "ProbeStatus", Quantity::code},
      {cia402::positive_1_position.id(), "ProbePosition", Quantity::position},
      {cia402::positive_1_time_ns.id(), "ProbeTime", Quantity::time, "Since the last SYNC"},
      {cia402::positive_1_edge_count.id(), "EdgeCounter", Quantity::count},
      {cia402::following_error.id(), "FollowingError", Quantity::position},
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
      {object::any_status.id(), "AxisStatusBits", Quantity::code, status_bits.c_str()},
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
  return {
#define NMT_STATE(number, name, title, words) {number, title},
#include "firmware/canopen/codes.def"
  };
}

ValueNames nmt_commands() {
  using canopen::NmtCommand;
  return {named(NmtCommand::start, "start"), named(NmtCommand::stop, "stop"),
          named(NmtCommand::enter_pre_operational, "enter pre-operational"),
          named(NmtCommand::reset_node, "reset node"),
          named(NmtCommand::reset_communication, "reset communication")};
}

ValueNames node_states() {
  return {
#define NODE_STATE(number, name, title, words) {number, title},
#include "firmware/node/states.def"
  };
}

ValueNames touch_verdicts() {
  ValueNames names;
  for (std::uint8_t v = 0; v < kTouchVerdicts; ++v)
    names.emplace_back(v, code(static_cast<TouchVerdict>(v)));
  return names;
}

ValueNames error_codes() {
  ValueNames names{
#define ERROR_CODE(number, name, title, sentence) {number, title},
#include "firmware/canopen/codes.def"
      named(kCommunicationErrorCode, "communication"),
      named(kFollowingErrorCode, "following error"),
  };
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace volcomp::host
