#pragma once
// The error of the tool as the workpiece sees it: E = Tᵉ T⁻¹, Tᵉ and T the pose of the tool frame
// in the frame of the workpiece holder with and without errors. It acts on the left: on points in
// work coordinates, whatever point of the tool they belong to (docs/papers/internal-helical.md,
// eqs. 9 and 10).

#include "comp/metrology/tables/volumetric.hpp"

namespace volcomp {

// First order: a point at P of the work frame moves by delta + eps × P.
struct LeftError {
  Vec3 delta = Vec3::Zero();  // of the point at the origin of the work frame, mm
  Vec3 eps = Vec3::Zero();    // rad

  [[nodiscard]] Vec3 at(const Vec3& P) const { return delta + eps.cross(P); }
};

// The pose of the tool holder in the frame of the workpiece holder, tool → work.
[[nodiscard]] Frame tool_in_work(const MachineChain& chain, const Pose& q);

// The same with errors, R and t to round-off of the product. The linear rotation model, which is
// none, leaves an R that is not orthonormal; use it only to reproduce the printed equations.
[[nodiscard]] Frame actual_tool_in_work(const MachineChain& chain, const Pose& q,
                                        const ErrorSet& errors, RotationModel model);

// Σ σ_i [R_i δ_i + t_i × (R_i ε_i)] and Σ σ_i R_i ε_i, every frame ideal and seen from the work
// frame.
[[nodiscard]] LeftError left_error(const MachineChain& chain, const Pose& q,
                                   const ErrorSet& errors);

// The response of one number to the six error motions of an NC axis: gain.dot(e).
using SensitivityRow = Eigen::Matrix<double, 6, 1>;
using SensitivityRows = std::array<SensitivityRow, kMaxAxes>;

// Gradient of n · (delta + eps × P) with respect to all error motions, by NC axis: mm per mm and
// mm per rad for a unit vector n, both in the work frame.
[[nodiscard]] SensitivityRows left_error_sensitivity(const MachineChain& chain, const Pose& q,
                                                     const Vec3& P, const Vec3& n);

}  // namespace volcomp
