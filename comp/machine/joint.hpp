#pragma once
// One joint of a kinematic chain: fixed offset, then ideal motion, then the error motion on the
// moving side. A literal type, so that a machine can be compiled in.

#include <array>
#include <cstdint>

namespace volcomp {

enum class JointKind : std::uint8_t { fixed, prismatic, rotary };
enum class Axis : std::uint8_t { x, y, z };

// Which side of the machine a body is on, seen from the last body that both branches share.
enum class Branch : std::uint8_t { none, tool, work };

struct Joint {
  JointKind kind = JointKind::fixed;
  Axis axis = Axis::x;
  std::int8_t sign = 1;            // motion = sign × NC coordinate; never applied to an error
  Branch branch = Branch::none;    // filled in by MachineChain
  std::uint8_t nc_axis = 0;        // index of the NC coordinate, 0…7; unused when fixed
  char letter = '\0';              // name of the NC axis, for instance 'X'
  std::array<double, 3> offset{};  // mm, before the motion, in the parent's frame
  std::array<double, 9> orientation{1, 0, 0, 0, 1,
                                    0, 0, 0, 1};  // row-major rotation before the motion

  [[nodiscard]] constexpr bool moves() const { return kind != JointKind::fixed; }
};

constexpr std::size_t index(Axis axis) { return static_cast<std::size_t>(axis); }

// +1 on the tool branch, −1 on the workpiece branch (conventions, section 2).
constexpr double branch_sign(Branch branch) { return branch == Branch::work ? -1.0 : 1.0; }

}  // namespace volcomp
