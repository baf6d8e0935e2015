// What a controller does to the objects of a Cia402Drive, over PDO or SDO.

#include <algorithm>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "host_sim/sim/drives/cia402_drive.hpp"
#include "host_sim/sim/drives/cia402_touch_probe.hpp"

namespace volcomp::sim {

namespace cia402 = host::cia402;
using canopen::AbortCode;

namespace {

// Objects whose writing does something at once. The target comes before the controlword that may
// have arrived with it: a drive that this controlword enables waits for the next target.
constexpr std::array<std::uint16_t, 5> kActedUpon{cia402::target.index, cia402::home_offset.index,
                                                  cia402::mode.index, cia402::function.index,
                                                  cia402::controlword.index};

bool is_supported(host::OperationMode mode) {
  return mode == host::OperationMode::none || mode == host::OperationMode::homing ||
         mode == host::OperationMode::cyclic_position;
}

bool maps(const canopen::Pdo& pdo, std::uint16_t index) {
  const canopen::PdoParameters& p = pdo.parameters();
  return std::any_of(p.mapping.begin(), p.mapping.begin() + p.count, [index](std::uint32_t entry) {
    return canopen::object_of(entry).index == index;
  });
}

}  // namespace

host::OperationMode Cia402Drive::mode() const {
  return static_cast<host::OperationMode>(objects_.mode_display);
}

bool Cia402Drive::in_cyclic_position() const {
  return machine_.enabled() && mode() == host::OperationMode::cyclic_position;
}

bool Cia402Drive::stays_in_quick_stop() const {
  return objects_.quick_stop_option == host::kQuickStopThenStay;
}

std::int32_t Cia402Drive::on_wire(std::int64_t units) const {
  if (settings_.behaviour.range)
    return static_cast<std::int32_t>(settings_.behaviour.range->inside(units));
  return settings_.rotary ? wrapped(units) : saturated(units);
}

void Cia402Drive::received(const canopen::Pdo& pdo, std::uint64_t) {
  for (const std::uint16_t index : kActedUpon) {
    if (maps(pdo, index)) object_changed(index);
  }
  if (settings_.behaviour.target_acts == DriveBehaviour::TargetActs::at_reception) follow_at_once();
}

void Cia402Drive::written(canopen::ObjectId object, std::uint64_t) {
  object_changed(object.index);
  publish();
}

void Cia402Drive::object_changed(std::uint16_t index) {
  if (index == cia402::target.index) target_fresh_ = true;
  if (index == cia402::target.index && in_cyclic_position()) target_arrived_ = true;
  if (index == cia402::home_offset.index) home_offset_given_ = true;
  if (index == cia402::mode.index) change_mode();
  if (index == cia402::function.index) apply_function(objects_.probe);
  if (index == cia402::controlword.index) control();
}

void Cia402Drive::control() {
  const std::uint16_t risen = objects_.controlword & ~last_controlword_;
  last_controlword_ = objects_.controlword;
  const bool was_enabled = machine_.enabled();
  machine_.control(objects_.controlword, stays_in_quick_stop());
  if (machine_.enabled() && !was_enabled) await_target();
  if (machine_.state() == host::PowerState::switch_on_disabled &&
      fault_ != canopen::ErrorCode::none) {
    device_.emergency().clear(fault_, 0);
    fault_ = canopen::ErrorCode::none;
  }
  if (machine_.enabled() && mode() == host::OperationMode::homing &&
      (risen & kControlHomingStart) != 0)
    home_here();
}

// A mode this drive has not got, or the one it is in, changes nothing.
void Cia402Drive::change_mode() {
  const auto wanted = static_cast<host::OperationMode>(objects_.mode);
  if (!is_supported(wanted) || wanted == mode()) return;
  objects_.mode_display = objects_.mode;
  homing_attained_ = false;
  await_target();
}

// The encoder is absolute: without a home offset of its own, homing confirms what it reads.
void Cia402Drive::home_here() {
  if (home_offset_given_) axis_.home(objects_.home_offset);
  demand_ = axis_.reading();
  referenced_ = homing_attained_ = true;
}

// Choices that are not a range.
bool Cia402Drive::possible(canopen::ObjectId object, std::int64_t value) const {
  switch (object.index) {
    case cia402::quick_stop_option.index:
      return value == host::kQuickStopThenOff || value == host::kQuickStopThenStay;
    case cia402::fault_option.index:
      return value == host::kFaultOff || value == host::kFaultBrake;
    case cia402::mode.index:
      return is_supported(static_cast<host::OperationMode>(value));
    case cia402::cycle_value.index:  // the servo clock has one period
      return value == (object.sub == 1 ? static_cast<std::int8_t>(objects_.cycle_value)
                                       : objects_.cycle_exponent);
    default:
      return true;
  }
}

// The device takes every placeholder in an RPDO; the data sheet of a drive may grant fewer. An
// expedited download of an entry of a mapping (CiA 301, 7.2.4.3.3) is refused in its place.
bool Cia402Drive::refuse_dummy(const hal::CanFrame& frame) {
  constexpr std::uint16_t kEndOfTypes = 0x1000;
  constexpr std::uint8_t kAbort = 0x80;
  const unsigned own_id = canopen::kSdoRequest + unsigned{settings_.node_id};
  if (!settings_.profile || frame.id != own_id || frame.data[0] >> 5U != 1) return false;
  const auto index = static_cast<std::uint16_t>(load_le(&frame.data[1], 2));
  const bool entry = index >= canopen::PdoTable::kReceiveMapping &&
                     index < canopen::PdoTable::kTransmitCommunication && frame.data[3] > 0;
  const canopen::ObjectId object = canopen::object_of(load_u32(&frame.data[4]));
  const bool dummy = entry && object.index > 0 && object.index < kEndOfTypes;
  if (!dummy || settings_.profile->may_map(canopen::PdoKind::receive, object)) return false;
  hal::CanFrame answer = frame;
  answer.id = static_cast<std::uint16_t>(canopen::kSdoResponse + settings_.node_id);
  answer.data[0] = kAbort;
  store_le(&answer.data[4], 4, static_cast<std::uint32_t>(AbortCode::not_mappable));
  refusal_ = answer;
  return true;
}

bool Cia402Drive::refuse_length(const hal::CanFrame& frame) {
  constexpr auto kTooLong = static_cast<canopen::ErrorCode>(0x8220);
  if (!settings_.behaviour.exact_length || !operational_) return false;
  const bool refused = std::any_of(receive_.begin(), receive_.end(), [&](const canopen::Pdo& pdo) {
    return pdo.valid() && pdo.parameters().cob_id == frame.id && frame.size > pdo.bytes();
  });
  if (refused) device_.emergency().raise(kTooLong, 0);
  return refused;
}

bool Cia402Drive::offer(hal::CanFrame& frame, std::uint64_t now_us) {
  offered_refusal_ = powered_ && refusal_.has_value();
  if (!offered_refusal_) return powered_ && device_.offer(frame, now_us);
  frame = *refusal_;
  return true;
}

void Cia402Drive::taken(std::uint64_t now_us) {
  if (offered_refusal_)
    refusal_.reset();
  else
    device_.taken(now_us);
}

AbortCode Cia402Drive::before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes) {
  const std::size_t size = bytes.size();
  if (size != 1 && size != 2) return AbortCode::none;  // as large as the choices are
  const std::int64_t value = load_le_signed(bytes.data(), size);
  return possible(object, value) ? AbortCode::none : AbortCode::invalid_value;
}

void Cia402Drive::before_read(canopen::ObjectId) {}

AbortCode Cia402Drive::read_domain(canopen::ObjectId, Span<const std::uint8_t>&) {
  return AbortCode::no_object;
}

AbortCode Cia402Drive::begin_domain(canopen::ObjectId, std::size_t, Span<std::uint8_t>&) {
  return AbortCode::no_object;
}

AbortCode Cia402Drive::finish_domain(canopen::ObjectId, std::size_t) {
  return AbortCode::no_object;
}

}  // namespace volcomp::sim
