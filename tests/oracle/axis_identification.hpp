#pragma once
// Error functions of one axis after the other from targets that each axis carries
// (docs/papers/l300g.md, "What we do"): the axis stands at its nodes, all others at a reference
// pose, where they are an erroneous, already identified parent.

#include "comp/machine/machine_chain.hpp"
#include "tests/oracle/rigid_fit.hpp"

namespace volcomp {

// What was measured of one axis.
struct AxisTargets {
  Span<const double> nodes;   // NC coordinates, mm or rad, strictly increasing
  Span<const Vec3> position;  // of the targets in the moving frame, mm
  Span<const Vec3> measured;  // in base, node by node, mm
  double sigma = 0.0;         // of a measured coordinate, mm; 0: outliers are not looked for
};

// One error motion per node into `motion`, which has as many elements as there are nodes; untouched
// when anything is refused: length_mismatch; with the node as `target` and the target as `index`,
// unit_suspected (displaced by more than 1 mm), what fit_rigid refuses, and outlier (more than 4 σ
// off the fit).
Status identify_axis(const Frame& parent, const Joint& joint, const AxisTargets& targets,
                     Span<ErrorMotion> motion);

// Before `nc_axis` is identified, the axes it hangs on must be (`identified`, a bit each), or stand
// where their errors are taken to be zero. parent_not_identified (axis), of the innermost that is
// neither.
Status check_order(const MachineChain& chain, std::size_t nc_axis, std::uint32_t identified,
                   const Pose& q, const Pose& reference);

// The frame that the joint at the end of `path` hangs its children on, errors included: `count`
// bodies of the path, from base.
[[nodiscard]] Frame actual_frame(const MachineChain& chain, const BodyPath& path, std::size_t count,
                                 const Pose& q, const ErrorSet& errors);

}  // namespace volcomp
