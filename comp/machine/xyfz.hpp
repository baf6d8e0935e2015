#pragma once
// The XYFZ machine of Zhao et al. (docs/papers/xyfz.md): X on Y on the bed, both carrying the
// workpiece; Z on the column carries the tool. NC axes 0 = X, 1 = Y, 2 = Z.

#include "comp/machine/machine_chain.hpp"

namespace volcomp {

struct XyfzOffsets {
  std::array<double, 3> b12{};         // Y frame → X frame at machine zero, mm
  std::array<double, 3> b03{};         // base → Z frame at machine zero, mm
  std::array<double, 3> tool_point{};  // P_t in the Z frame, mm
};

// Squareness parameters of the paper's eq. 10: C = (Z a_xz, X a_xy − Z a_yz, 0). In ISO 230-1
// letters EC0Y = −a_xy, EB0Z = a_xz, EA0Z = a_yz. rad.
struct XyfzSquareness {
  double a_xy = 0.0;
  double a_xz = 0.0;
  double a_yz = 0.0;
};

// Eq. 11–13: reading heads as frame origins, offsets B12 and B03, squareness as a translation.
[[nodiscard]] constexpr MachineDescription xyfz_optimised(const XyfzOffsets& offsets) {
  MachineDescription d;
  d.body_count = 4;
  d.body[1].lower = 1;
  d.body[1].joint = {JointKind::prismatic,       Axis::y, -1, Branch::none, 1, 'Y', {},
                     {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  d.body[2].lower = 2;
  d.body[2].joint = {JointKind::prismatic,       Axis::x, -1, Branch::none, 0, 'X', offsets.b12,
                     {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  d.body[3].lower = 1;
  d.body[3].joint = {JointKind::prismatic,       Axis::z, 1, Branch::none, 2, 'Z', offsets.b03,
                     {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  d.work_body = 3;
  d.tool_body = 4;
  d.tool_point = offsets.tool_point;
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  return d;
}

// Eq. 1–3, the model without Abbe offsets: every frame at the machine zero point, squareness as
// rotations of fixed bodies (C_xy under the X slide, C_yz and C_xz under the Z slide).
[[nodiscard]] MachineDescription xyfz_naive(const XyfzSquareness& squareness,
                                            const std::array<double, 3>& tool_point);

// Translation per mm of each axis, eq. 10.
[[nodiscard]] DirectionErrors xyfz_directions(const XyfzSquareness& squareness);

}  // namespace volcomp
