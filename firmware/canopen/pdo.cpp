#include "firmware/canopen/pdo.hpp"

#include <cstring>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"

namespace volcomp::canopen {
namespace {

// Types as indices: placeholders that skip bytes of an RPDO (CiA 301, section 7.4.7).
constexpr std::uint16_t kLastDummy = 0x0007;

AbortCode resolve(std::uint32_t mapping, PdoKind kind, const ObjectDictionary& objects,
                  std::uint8_t*& value) {
  const ObjectId object = object_of(mapping);
  const std::size_t bits = mapping & 0xFFU;
  value = nullptr;
  if (object.index <= kLastDummy) {
    const bool whole = bits == 8U * size_of(static_cast<DataType>(object.index));
    const bool dummy = kind == PdoKind::receive && object.index > 1 && object.sub == 0 && whole;
    return dummy ? AbortCode::none : AbortCode::not_mappable;
  }
  const ObjectDictionary::Found found = objects.find(object);
  if (found.why != AbortCode::none) return found.why;
  const bool allowed = found.entry != nullptr &&
                       found.entry->has(kind == PdoKind::receive ? kReceive : kTransmit) &&
                       bits == 8U * found.entry->size();
  if (!allowed) return AbortCode::not_mappable;
  value = found.value;
  return AbortCode::none;
}

}  // namespace

AbortCode Pdo::configure(const PdoParameters& parameters, PdoKind kind,
                         const ObjectDictionary& objects) {
  Pieces pieces;
  std::size_t bytes = 0;
  std::uint32_t arrivals = 0;
  for (std::size_t i = 0; i < parameters.count; ++i) {
    const AbortCode why = resolve(parameters.mapping[i], kind, objects, pieces.value[i]);
    if (why != AbortCode::none) return why;
    pieces.bytes[i] = static_cast<std::uint8_t>((parameters.mapping[i] & 0xFFU) / 8U);
    bytes += pieces.bytes[i];
    if (bytes > 8) return AbortCode::mapping_too_long;
    if (kind == PdoKind::receive) arrivals |= objects.arrival(object_of(parameters.mapping[i]));
  }
  parameters_ = parameters;
  set_communication(parameters);
  pieces_ = pieces;
  arrivals_ = arrivals;
  bytes_ = static_cast<std::uint8_t>(bytes);
  return AbortCode::none;
}

void Pdo::set_communication(const PdoParameters& parameters) {
  parameters_.cob_id = parameters.cob_id;
  parameters_.type = parameters.type;
  parameters_.inhibit_100us = parameters.inhibit_100us;
  parameters_.event_timer_ms = parameters.event_timer_ms;
  valid_id_ = valid() ? id() : kNoFrame;
}

void Pdo::scatter(const hal::CanFrame& frame) const {
  std::size_t at = 0;
  for (std::size_t i = 0; i < parameters_.count; ++i) {
    const std::uint8_t bytes = pieces_.bytes[i];
    if (pieces_.value[i] != nullptr) std::memcpy(pieces_.value[i], frame.data.data() + at, bytes);
    at += bytes;
  }
}

void Pdo::gather(hal::CanFrame& frame) const {
  frame = {};
  frame.id = id();
  for (std::size_t i = 0; i < parameters_.count; ++i) {
    std::memcpy(frame.data.data() + frame.size, pieces_.value[i], pieces_.bytes[i]);
    frame.size = static_cast<std::uint8_t>(frame.size + pieces_.bytes[i]);
  }
}

PdoTable::Place PdoTable::place(std::uint16_t index) const {
  Place at;
  at.mapping = (index & 0x0200U) != 0;
  at.kind = index < kTransmitCommunication ? PdoKind::receive : PdoKind::transmit;
  const bool receive = at.kind == PdoKind::receive;
  const Span<Pdo>& pdos = receive ? receive_ : transmit_;
  const std::size_t number = index & 0x01FFU;
  if (owns(index) && number < pdos.size()) at.pdo = &pdos[number];
  at.of_cycle = number < (receive ? of_cycle_.receive : of_cycle_.transmit);
  return at;
}

AbortCode PdoTable::read(ObjectId object, Value& value) const {
  const Place at = place(object.index);
  if (at.pdo == nullptr) return AbortCode::no_object;
  const PdoParameters& p = at.pdo->parameters();
  if (at.mapping) {
    if (object.sub > kMostMapped) return AbortCode::no_subindex;
    value = object.sub == 0 ? Value{p.count, 1} : Value{p.mapping[object.sub - 1U], 4};
    return AbortCode::none;
  }
  switch (object.sub) {
    case 0:
      value = {at.kind == PdoKind::receive ? 2U : 5U, 1};
      return AbortCode::none;
    case 1:
      value = {p.cob_id, 4};
      return AbortCode::none;
    case 2:
      value = {p.type, 1};
      return AbortCode::none;
    default:
      break;
  }
  if (at.kind == PdoKind::transmit && object.sub == 3)
    value = {p.inhibit_100us, 2};
  else if (at.kind == PdoKind::transmit && object.sub == 5)
    value = {p.event_timer_ms, 2};
  else
    return AbortCode::no_subindex;
  return AbortCode::none;
}

AbortCode PdoTable::writable(ObjectId object, std::uint8_t& bytes) const {
  Value value;
  const AbortCode why = read(object, value);
  if (why != AbortCode::none) return why;
  bytes = value.bytes;
  const bool count_of_record = !place(object.index).mapping && object.sub == 0;
  return count_of_record ? AbortCode::read_only : AbortCode::none;
}

AbortCode PdoTable::write(ObjectId object, Span<const std::uint8_t> bytes, bool operational) {
  std::uint8_t wanted = 0;
  const AbortCode why = writable(object, wanted);
  if (why != AbortCode::none) return why;
  if (bytes.size() != wanted) return AbortCode::wrong_length;
  const Place at = place(object.index);
  if (at.of_cycle && operational) return AbortCode::device_state;
  const auto value = static_cast<std::uint32_t>(load_le(bytes.data(), wanted));
  return at.mapping ? write_mapping(at, object.sub, value)
                    : write_communication(at, object.sub, value);
}

// The identifier may change only while the PDO is invalid. No port hears remote requests, so a TPDO
// that is valid does not promise to answer them (bit 30; CiA 301, 7.5.2.37).
AbortCode PdoTable::write_cob_id(const Place& place, PdoParameters& p, std::uint32_t value) {
  const auto id = static_cast<std::uint16_t>(value & hal::kMaxCanId);
  const bool turns_valid = (value & kPdoInvalid) == 0;
  const bool extended = (value & 0x3FFF'F800U) != 0;
  const bool remote = place.kind == PdoKind::transmit && (value & kPdoNoRtr) == 0;
  const bool changes = place.pdo->valid() && id != place.pdo->id();
  if (extended || (turns_valid && (restricted(id) || remote || changes)))
    return AbortCode::invalid_value;
  p.cob_id = value;
  return AbortCode::none;
}

AbortCode PdoTable::write_communication(const Place& place, std::uint8_t sub, std::uint32_t value) {
  PdoParameters p = place.pdo->parameters();
  if (place.timed() && ((sub == 2 && value < kEventType) || (sub == 5 && value != 0)))
    return AbortCode::invalid_value;
  if (sub == 1) {
    const AbortCode why = write_cob_id(place, p, value);
    if (why != AbortCode::none) return why;
  } else if (sub == 2) {
    if (value > kMostCyclicType && value < kEventType) return AbortCode::invalid_value;
    p.type = static_cast<std::uint8_t>(value);
  } else if (sub == 3) {
    if (place.pdo->valid()) return AbortCode::unsupported_access;
    p.inhibit_100us = static_cast<std::uint16_t>(value);
  } else {
    p.event_timer_ms = static_cast<std::uint16_t>(value);
  }
  place.pdo->set_communication(p);
  return AbortCode::none;
}

AbortCode PdoTable::write_mapping(const Place& place, std::uint8_t sub, std::uint32_t value) {
  PdoParameters p = place.pdo->parameters();
  if (place.pdo->valid()) return AbortCode::unsupported_access;
  // What only the application sends is what it has judged. Tools may write the same again, count 0
  // first; the mapping stays as it is.
  if (place.timed()) {
    const bool same = sub == 0 ? value == 0 || value == p.count : value == p.mapping[sub - 1U];
    return same ? AbortCode::none : AbortCode::not_mappable;
  }
  if (sub == 0) {
    if (value > kMostMapped) return AbortCode::mapping_too_long;
    p.count = static_cast<std::uint8_t>(value);
    return place.pdo->configure(p, place.kind, objects_);
  }
  if (p.count != 0) return AbortCode::unsupported_access;
  std::uint8_t* unused = nullptr;
  const AbortCode why = value == 0 ? AbortCode::none : resolve(value, place.kind, objects_, unused);
  if (why != AbortCode::none) return why;
  p.mapping[sub - 1U] = value;
  return place.pdo->configure(p, place.kind, objects_);
}

}  // namespace volcomp::canopen
