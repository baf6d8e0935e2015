#pragma once
// A machine at one position: where every joint is ideally, where the tips really are, and what a
// small error of a joint does there.

#include <array>

#include "comp/machine/machine_chain.hpp"

namespace volcomp::host::identify {

// Ideal frames in base.
struct ChainGeometry {
  Frame work;
  Frame tool;
  std::array<Frame, kMaxAxes> joint;     // of each NC axis, after its motion
  std::array<double, kMaxAxes> side{};   // +1 on the tool branch, −1 on the workpiece branch
  std::array<double, kMaxAxes> sense{};  // of its motion against the NC coordinate

  // Orientation of the tool in the work frame.
  [[nodiscard]] Mat3 tool_in_work() const { return work.R.transpose() * tool.R; }
  // A point of the tool, in the work frame.
  [[nodiscard]] Vec3 in_work(const Vec3& tool_point) const {
    return work.apply_inverse(tool.apply(tool_point));
  }
};
[[nodiscard]] ChainGeometry ideal_geometry(const MachineChain& chain, const Pose& q);

// The tips with these errors (body, moving side), exactly: rotation model rxryrz.
struct TipFrames {
  Frame work;
  Frame tool;

  [[nodiscard]] Vec3 in_work(const Vec3& tool_point) const {
    return work.apply_inverse(tool.apply(tool_point));
  }
};
[[nodiscard]] TipFrames actual_tips(const MachineChain& chain, const Pose& q,
                                    const ErrorSet& errors);

// First order in the six errors of a joint, in base: what a point moves, tool against work, and
// what the tool turns.
using ErrorEffect = Eigen::Matrix<double, 3, 6>;
[[nodiscard]] ErrorEffect point_effect(const ChainGeometry& g, std::size_t axis, const Vec3& point);
[[nodiscard]] ErrorEffect turn_effect(const ChainGeometry& g, std::size_t axis);

// ∂p/∂q of a linear axis in the work frame.
[[nodiscard]] Vec3 slide_in_work(const MachineChain& chain, const ChainGeometry& g,
                                 std::size_t axis);

// Moves the linear axes so that the ideal tip goes by `way`, work frame; false where three of them
// do not span the space.
bool move_by(const MachineChain& chain, const ChainGeometry& g, const Vec3& way, Pose& q);

// Rotation by the length of a vector about its direction, exactly a rotation.
[[nodiscard]] Mat3 exponential(const Vec3& turn);

}  // namespace volcomp::host::identify
