#pragma once
// What process data bring, a bit each: the device finds the bits of a PDO when it is mapped
// (canopen::Dictionary::arrival), so what a frame has brought is one word.

#include "firmware/canopen/object_access.hpp"
#include "firmware/node/node_features.hpp"
#include "firmware/node/tables/node_compensator.hpp"
#include "firmware/node/thermal/thermal_objects.hpp"

namespace volcomp::node {

// First bit of each kind; a bit per axis, per input, or one.
struct Arrival {
  static constexpr unsigned kTarget = 0;                           // 2011h
  static constexpr unsigned kActual = kTarget + kNodeAxes;         // 2014h, with 2013h
  static constexpr unsigned kHeld = kActual + kNodeAxes;           // 2016h
  static constexpr unsigned kLatched = kHeld + kNodeAxes;          // 2017h
  static constexpr unsigned kCounted = kLatched + kNodeAxes;       // 2019h
  static constexpr unsigned kProcessState = kCounted + kNodeAxes;  // 201Ah
  static constexpr unsigned kTemperature = kProcessState + 1;      // 2700h
};
static_assert(Arrival::kTemperature + kTemperatureInputs <= 32);

constexpr std::uint32_t bit(std::size_t number) { return 1U << number; }

inline constexpr std::uint32_t kEveryAxis = bit(kNodeAxes) - 1U;

// The axes of one kind among what has arrived.
constexpr std::uint32_t axes_of(std::uint32_t arrived, unsigned first) {
  return arrived >> first & kEveryAxis;
}

// 0: nothing waits for this object.
[[nodiscard]] std::uint32_t arrival_of(canopen::ObjectId object);

}  // namespace volcomp::node
