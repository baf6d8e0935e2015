#pragma once
// Volumetric error: actual − nominal pose of the tool relative to the work for the same encoder
// values.

#include "comp/machine/machine_chain.hpp"

namespace volcomp {

// The two points whose coincidence defines the error, each in the frame of its branch tip (mm).
struct PointPair {
  Vec3 tool;
  Vec3 work;
};

// Tool point of the machine, and the work point it ideally coincides with at q.
[[nodiscard]] PointPair ideal_points(const MachineChain& chain, const Pose& q,
                                     const Vec3& tool_point);

struct VolumetricError {
  Vec3 position_base;     // tool point − work point, machine frame, mm
  Vec3 position_work;     // the same in the frame of the workpiece holder
  Vec3 orientation_base;  // rotation vector, rad
  Vec3 orientation_work;
};

// Squareness as a pure translation in base: C = Σ direction[axis] · q[axis] (conventions, section
// 2).
[[nodiscard]] Vec3 squareness_translation(const MachineChain& chain, const Pose& q,
                                          const DirectionErrors& directions);

// Exact chain for the selected rotation model, evaluated by a recursion of deviations (no
// difference of large products). `squareness` is added to the tool point in base. Any model, any
// chain.
[[nodiscard]] VolumetricError exact_error(const MachineChain& chain, const Pose& q,
                                          const ErrorSet& errors, const Vec3& squareness,
                                          RotationModel model, const PointPair& points);

// Σ σ [R δ + (R ε) × (p − o)] + squareness, every frame ideal (conventions, section 2).
[[nodiscard]] VolumetricError first_order_error(const MachineChain& chain, const Pose& q,
                                                const ErrorSet& errors, const Vec3& squareness,
                                                const PointPair& points);

}  // namespace volcomp
