#pragma once
// The machine as the tick walks it: tool tip → base, then base → work tip, in float nm. Built from
// the same MachineDescription whether the machine is compiled in (constexpr, the walk unrolls) or
// loaded from an image.

#include <array>
#include <cstdint>

#include "comp/machine/machine_description.hpp"

namespace volcomp {

inline constexpr std::uint8_t kNotCorrecting = 0xFF;
inline constexpr std::uint8_t kNotCarried = 0xFF;
inline constexpr std::uint8_t kNotOrienting = 0xFF;

// What a joint does to a point: one jump of a loaded machine.
enum class Motion : std::uint8_t { along_x, along_y, along_z, about_x, about_y, about_z, none };

struct RuntimeStep {
  JointKind kind = JointKind::fixed;
  Axis axis = Axis::x;
  Motion motion = Motion::none;
  bool work = false;
  bool plain = false;  // no orientation, and no column to carry or to turn
  bool has_offset = false;
  bool has_orientation = false;
  bool has_error = false;  // a constant one: of a fixed body, or of those that hang on an axis
  std::uint8_t body = 0;
  std::uint8_t nc_axis = 0;
  std::uint8_t correcting = kNotCorrecting;  // index among the correcting axes
  std::uint8_t orienting = kNotOrienting;    // of a rotary axis: index among the orienting axes
  std::uint8_t column = kNotCarried;         // where the walk carries its Jacobian column
  std::uint8_t columns_before = 0;           // carried ones of its branch nearer to the tip
  float sign = 1.0F;                         // of the NC coordinate
  float sense = 1.0F;  // of the motion as the walk meets it: −sign towards the work tip
  std::array<float, 3> offset_nm{};
  std::array<float, 9> orientation{};
  std::array<float, 6> error{};  // nm, rad; of an axis: its tables hold it

  [[nodiscard]] constexpr bool corrects() const { return correcting != kNotCorrecting; }
  [[nodiscard]] constexpr bool carried() const { return column != kNotCarried; }
};

inline constexpr float kTurnsPerRad = 683565275.6F;  // 2^32 / 2π, an output in a radian

// What is known beforehand of the Jacobian of the correcting axes, and saves the tick work.
enum class InverseForm : std::uint8_t {
  aligned,      // three linear axes that always lie along X, Y, Z: a signed selection
  constant,     // linear axes that no rotary axis turns: J⁻¹ comes with the tables
  one_varying,  // two aligned axes and one whose column changes with the pose
  general,
};

struct InversePlan {
  InverseForm form = InverseForm::general;
  std::array<std::uint8_t, kMaxCorrecting> component{};  // of the aligned ones
  std::array<float, kMaxCorrecting> gain{};
  std::array<float, kMaxCorrecting> units{};          // output units per nm or rad of each
  std::array<std::uint8_t, kMaxCorrecting> column{};  // where the walk carries the others
  std::uint8_t varying = 0;                           // the one of one_varying
  std::uint8_t varying_component = 0;                 // what the aligned ones leave to it
};

enum class RuntimeModel : std::uint8_t {
  automatic,     // folded for linear axes only, recursion as soon as one is rotary (conventions,
                 // section 4)
  folded,        // first-order sum, levers folded into the tables
  second_order,  // deviation recursion
};

struct RuntimeChain {
  std::array<RuntimeStep, kMaxBodies> step{};
  std::uint8_t steps = 0;
  std::uint8_t tool_steps = 0;
  std::uint8_t axes = 0;
  std::uint8_t correcting_count = 0;
  std::uint8_t orienting_count = 0;
  std::array<std::uint8_t, kMaxOrienting> orienting{};    // NC axes
  std::array<std::uint8_t, kMaxCorrecting> correcting{};  // NC axes
  std::array<std::uint8_t, kMaxAxes> correcting_index{};  // by NC axis, or kNotCorrecting
  std::array<JointKind, kMaxAxes> kind{};                 // by NC axis
  std::array<char, kMaxAxes> letter{};
  std::uint8_t first_folded = 0;  // step of the first axis met from the work tip
  bool folded = true;
  bool has_orientation = false;
  bool has_constant_error = false;
  std::uint8_t tool_columns = 0;  // carried along the tool branch; those of the work branch follow
  // Of the recursion: the frame of the tool in the one of the last step on its branch.
  std::array<float, 3> tool_offset_nm{};
  std::array<float, 9> tool_orientation{};
  InversePlan inverse{};

  [[nodiscard]] constexpr std::uint8_t orienting_index(std::size_t axis) const {
    for (std::uint8_t o = 0; o < orienting_count; ++o) {
      if (orienting[o] == axis) return o;
    }
    return kNotOrienting;
  }
};

// Whether the directions of the correcting axes are those of their positions with the offset: on
// machines of linear axes. What reversals do to an offset has a useful bound there, and a
// hysteresis above it keeps a direction from chasing itself. Elsewhere a direction is that of the
// position alone.
[[nodiscard]] constexpr bool directions_follow_offsets(const RuntimeChain& chain) {
  return chain.folded && chain.orienting_count == 0;
}

}  // namespace volcomp
