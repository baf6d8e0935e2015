#pragma once
// What goes into a tick, what comes out, and how it is set up.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "comp/core/status.hpp"
#include "comp/tick/offset_bounds.hpp"

namespace volcomp {

// One axis at one instant. Linear: nm; rotary: 2^-40 turn, counted through (not wrapped).
struct AxisSample {
  std::int64_t position = 0;
  bool valid = false;  // false: frame lost, encoder fault, not a number
  bool homed = false;  // referenced and enabled

  // Both, by one comparison.
  [[nodiscard]] bool good() const {
    std::uint16_t both = 0;
    std::memcpy(&both, reinterpret_cast<const unsigned char*>(this) + offsetof(AxisSample, valid),
                sizeof both);
    return both == 0x0101U;
  }
};
static_assert(offsetof(AxisSample, homed) == offsetof(AxisSample, valid) + 1);

// Status word per axis; what each bit means stands in codes.def.
enum StatusBit : std::uint16_t {
#define STATUS_BIT(bit, enumerator, name, NAME, words) enumerator = 1U << (bit),
#include "comp/tick/codes.def"
};
inline constexpr int kStatusBits = 15;

constexpr std::size_t bit_of(StatusBit status) {
  return static_cast<std::size_t>(__builtin_ctz(static_cast<unsigned>(status)));
}

template <std::size_t Axes>
struct TickInput {
  std::array<AxisSample, Axes> axis{};
};

template <std::size_t Axes>
struct TickOutput {
  std::array<std::int32_t, Axes> offset{};  // to add to the command: nm, or 2^-32 turn
  std::array<std::uint16_t, Axes> status{};
};

enum class PositionSource : std::uint8_t {
  target,  // 607Ah: the encoder will show target + offset, so E is taken there
  actual,  // 6064h or a latch: already contains the offset, nothing is added
};

// Units: nm (linear) or 2^-32 turn (rotary), per tick where stated.
struct AxisLimits : OffsetLimits {  // of the correction; soft_rate: dropped, not homed, coming back
  std::int32_t hysteresis = 2'000;  // of the direction, ≥ 0
  std::int64_t max_step =
      0;  // largest plausible |Δposition| per tick, run-time units; 0 = not checked
};

template <std::size_t Axes>
struct CompensatorSettings {
  std::array<AxisLimits, Axes> axis{};
  PositionSource source = PositionSource::target;
  std::uint32_t machine_id = 0;         // tables of another machine are refused; 0 = any
  std::uint32_t ramp_ticks = 200;       // of every change of tables or state, 1…2^24
  std::uint16_t stale_drop_ticks = 10;  // stale for more ticks than this: dropped
};

// Saturating counters; each counts how often a condition began. Written by the tick, read any time.
template <std::size_t Axes>
struct Diagnostics {
  std::uint32_t ticks = 0;
  std::uint32_t activations = 0;
  std::uint32_t rejections = 0;  // tables refused since start
  Status last_rejection{};       // why, and where
  std::uint32_t active_crc = 0;  // of the image behind the active tables
  std::array<std::array<std::uint16_t, kStatusBits>, Axes> began{};
  std::array<std::int32_t, Axes> largest{};  // largest |offset| put out
  // Largest |wanted offset − offset| that rate or acceleration left at the end of a tick.
  std::array<std::int32_t, Axes> largest_lag{};
};

}  // namespace volcomp
