#pragma once
// A touch of the probe: what the drives latched, what was made of it.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/machine/error_motion.hpp"
#include "comp/machine/machine_description.hpp"
#include "comp/tables/direction.hpp"

namespace volcomp {

// What became of an edge of the probe signal. The numbers are those of 2401h:02; what each means
// stands in codes.def.
enum class TouchVerdict : std::uint8_t {
#define VERDICT(number, name, sentence) name = (number),
#include "comp/tick/codes.def"
};
inline constexpr std::uint8_t kTouchVerdicts = 15;
[[nodiscard]] constexpr bool accepted(TouchVerdict verdict) {
  return verdict <= TouchVerdict::uncorrected;
}
// Stable machine-readable name, for instance "axis_missing".
[[nodiscard]] const char* code(TouchVerdict verdict);
// One plain sentence for a person.
[[nodiscard]] const char* sentence(TouchVerdict verdict);

// Run-time units: nm, or 2^-40 turn of a rotary axis.
struct LatchedAxis {
  std::int64_t position = 0;
  double velocity = 0.0;                     // at the latch, per second
  Direction direction = Direction::unknown;  // the axis arrived in
};

// One edge of the probe signal, seen by every axis in use. Unused axes are left at 0.
struct Touch {
  std::uint32_t sequence = 0;  // counts edges, rejected ones included
  TouchVerdict verdict = TouchVerdict::point;
  std::uint8_t axis = 0;  // NC axis the verdict is about
  std::array<LatchedAxis, kMaxAxes> latched{};
};

// The error of the machine at a pose.
struct PoseError {
  Vec3 base = Vec3::Zero();  // nm
  bool known = false;        // false: no tables
  bool within = true;        // false: an axis stands outside its table
};

}  // namespace volcomp
