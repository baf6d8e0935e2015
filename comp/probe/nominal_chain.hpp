#pragma once
// The ideal machine in double, for touches: where the tool point stands and how each axis moves it.
// The deviations come from the tick's float tables; positions of up to metres to the nanometre do
// not fit a float. No libm: the same bits on every target.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/machine/body_paths.hpp"
#include "comp/machine/error_motion.hpp"
#include "comp/machine/frame.hpp"

namespace volcomp {

// NC coordinates: nm, or 2^-40 turn of a rotary axis, reduced to one turn either way.
using LatchedPose = std::array<double, kMaxAxes>;

struct NominalPoint {
  Vec3 base;  // tool point, nm
  Vec3 part;  // the same in the frame of the part, nm
  Mat3 tool_to_base;
  Mat3 part_to_base;
  std::array<Vec3, kMaxAxes> column;  // motion over the part per nm or rad of an axis, base frame
};

class NominalChain {
 public:
  NominalChain() = default;
  // `machine` as MachineChain::build accepts it.
  [[gnu::cold]] explicit NominalChain(const MachineDescription& machine) { build(machine); }
  // As if constructed anew; without a second chain, for small stacks. Cold: for size where at() is
  // compiled for speed.
  [[gnu::cold]] void build(const MachineDescription& machine);

  [[nodiscard]] std::size_t axes() const { return axes_; }
  [[nodiscard]] bool rotary(std::size_t axis) const { return rotary_[axis]; }

  // `tool_point`: tool frame; `part`: its frame in that of the work; nm.
  void at(const LatchedPose& q, const Vec3& tool_point, const Frame& part,
          NominalPoint& nominal) const;

 private:
  struct Step {
    JointKind kind = JointKind::fixed;
    Axis axis = Axis::x;
    std::uint8_t nc_axis = 0;
    bool oriented = false;
    double sign = 1.0;
    Vec3 offset;  // nm
    Mat3 orientation;
  };
  [[gnu::cold]] void append(const MachineDescription& machine, const BodyPath& bodies);

  void walk_to_base(const LatchedPose& q, NominalPoint& nominal) const;
  void walk_to_work(const LatchedPose& q, NominalPoint& nominal) const;

  std::array<Step, kMaxBodies> step_{};  // tool, then work, each from base to its tip
  std::size_t tool_steps_ = 0;
  std::size_t steps_ = 0;
  std::array<bool, kMaxAxes> rotary_{};
  std::size_t axes_ = 0;
};

}  // namespace volcomp
