#pragma once
// From a lower-body array to the two branches of a machine: base → workpiece holder, base → tool
// holder.
//
// The machine frame ("base") is the frame of the last body that both branches share.

#include <array>
#include <cstdint>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/machine/body_paths.hpp"
#include "comp/machine/frame.hpp"

namespace volcomp {

using Pose = std::array<double, kMaxAxes>;           // NC coordinates, mm or rad, by NC axis
using ErrorSet = std::array<ErrorMotion, kMaxAxes>;  // internal convention, by NC axis
using DirectionErrors =
    std::array<Vec3, kMaxAxes>;  // squareness: translation in base per mm of an NC axis

[[nodiscard]] ErrorSet zero_errors();
[[nodiscard]] DirectionErrors zero_directions();

class MachineChain {
 public:
  // Validates and analyses. Refuses: too_many_bodies, parent_not_lower, not_one_root, bad_body,
  // bad_joint, not_a_rotation, bad_axis_index, too_many_axes; `out` is then unchanged.
  static Status build(const MachineDescription& description, MachineChain& out);

  // The same without a second copy of the description (2.6 KB), for a reader on a small stack:
  // write draft(), then complete(). After a refusal the chain must not be used.
  [[nodiscard]] MachineDescription& draft() { return description_; }
  Status complete();

  [[nodiscard]] const MachineDescription& description() const { return description_; }
  [[nodiscard]] const Joint& joint(std::uint8_t body) const {
    return description_.body[body].joint;
  }
  [[nodiscard]] const BodyPath& tool() const { return paths_.tool; }
  [[nodiscard]] const BodyPath& work() const { return paths_.work; }
  [[nodiscard]] std::size_t axis_count() const { return axis_count_; }
  [[nodiscard]] std::uint8_t body_of_axis(std::size_t nc_axis) const {
    return body_of_axis_[nc_axis];
  }
  [[nodiscard]] const Joint& axis(std::size_t nc_axis) const {
    return joint(body_of_axis_[nc_axis]);
  }
  [[nodiscard]] bool has_rotary() const;
  [[nodiscard]] Vec3 tool_point() const {
    const auto& p = description_.tool_point;
    return {p[0], p[1], p[2]};
  }

  // Error motion of a body: the one of its NC axis, or its constant one.
  [[nodiscard]] ErrorMotion error_of(std::uint8_t body, const ErrorSet& errors) const;

  // Ideal frame of a branch tip, tip → base.
  [[nodiscard]] Frame ideal(const BodyPath& path, const Pose& q) const;

 private:
  void analyse();

  MachineDescription description_{};
  BranchPaths paths_{};
  std::size_t axis_count_ = 0;
  std::array<std::uint8_t, kMaxAxes> body_of_axis_{};
};

// Checks a lower-body array alone: 0 ≤ lower(K) < K and exactly one root.
Status check_lower_body(Span<const std::uint8_t> lower);

}  // namespace volcomp
