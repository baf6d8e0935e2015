#pragma once
// What an SDO server does with the objects of its device: whole values in, whole values out. Both
// directions work on bytes in place; a domain (table image) is never copied.

#include <cstdint>

#include "comp/core/span.hpp"

namespace volcomp::canopen {

// SDO abort codes (CiA 301, table 22).
enum class AbortCode : std::uint32_t {
  none = 0,
#define ABORT_CODE(number, name, sentence) name = (number),
#include "firmware/canopen/codes.def"
};

// One plain sentence; also for codes another device made up.
[[nodiscard]] const char* sentence(AbortCode code);

struct ObjectId {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
};

// As a PDO maps an object: index << 16 | sub-index << 8 | bits.
constexpr std::uint32_t mapped(std::uint16_t index, std::uint8_t sub, std::uint8_t bits) {
  return std::uint32_t{index} << 16U | std::uint32_t{sub} << 8U | bits;
}
constexpr ObjectId object_of(std::uint32_t mapping) {
  return {static_cast<std::uint16_t>(mapping >> 16U), static_cast<std::uint8_t>(mapping >> 8U)};
}

constexpr bool operator==(ObjectId a, ObjectId b) { return a.index == b.index && a.sub == b.sub; }
constexpr bool operator!=(ObjectId a, ObjectId b) { return !(a == b); }

class ObjectAccess {
 public:
  // The bytes of the object, little-endian as they go over the bus. `source` stays valid until the
  // next call of any member, for a domain until the next download to it.
  virtual AbortCode begin_upload(ObjectId object, Span<const std::uint8_t>& source) = 0;

  // Where to put the incoming bytes: `sink` is as large as the object may become. `announced` is
  // the size the client announces, 0 = none; a size that does not fit is refused here.
  virtual AbortCode begin_download(ObjectId object, std::size_t announced,
                                   Span<std::uint8_t>& sink) = 0;
  // The first `size` bytes of the sink are complete: check them and make them the value.
  virtual AbortCode finish_download(ObjectId object, std::size_t size) = 0;
  // A download that began will not be finished (abort, timeout, new request).
  virtual void abandon_download(ObjectId object) = 0;

 protected:
  ObjectAccess() = default;
  ObjectAccess(const ObjectAccess&) = default;
  ObjectAccess& operator=(const ObjectAccess&) = default;
  ~ObjectAccess() = default;
};

}  // namespace volcomp::canopen
