#include "comp/metrology/gears/internal_grinder.hpp"

namespace volcomp {
namespace {

// Appends a body and returns its number.
std::uint8_t attach(MachineDescription& d, std::uint8_t lower, const Joint& joint) {
  Body& body = d.body[d.body_count];
  body.lower = lower;
  body.joint = joint;
  return ++d.body_count;
}

Joint joint_along(JointKind kind, Axis axis, std::size_t nc_axis, char letter,
                  const std::array<double, 3>& offset) {
  Joint joint;
  joint.kind = kind;
  joint.axis = axis;
  joint.nc_axis = static_cast<std::uint8_t>(nc_axis);
  joint.letter = letter;
  joint.offset = offset;
  return joint;
}

}  // namespace

MachineDescription internal_grinder(GrinderY y, const InternalGrinderOffsets& offsets) {
  const auto slide = [](Axis axis, std::size_t nc_axis, char letter,
                        const std::array<double, 3>& offset) {
    return joint_along(JointKind::prismatic, axis, nc_axis, letter, offset);
  };
  const Joint slide_y = slide(Axis::y, kGrinderY, 'Y', offsets.y);
  MachineDescription d;
  const std::uint8_t bed = attach(d, 0, {});
  std::uint8_t tip = attach(d, bed, slide(Axis::x, kGrinderX, 'X', offsets.x));
  tip = attach(d, tip, joint_along(JointKind::rotary, Axis::z, kGrinderC, 'C', offsets.c));
  d.work_body = attach(d, tip, {});
  tip = bed;
  if (y == GrinderY::under_z) tip = attach(d, tip, slide_y);
  tip = attach(d, tip, slide(Axis::z, kGrinderZ, 'Z', offsets.z));
  if (y == GrinderY::on_z) tip = attach(d, tip, slide_y);
  tip = attach(d, tip, joint_along(JointKind::rotary, Axis::x, kGrinderA, 'A', offsets.a));
  d.tool_body = attach(d, tip, {});
  d.correcting = {static_cast<std::uint8_t>(kGrinderC), static_cast<std::uint8_t>(kGrinderX)};
  d.correcting_count = 2;
  return d;
}

Pose grinder_pose(double x, double z, double c, double a) {
  Pose q{};
  q[kGrinderX] = x;
  q[kGrinderZ] = z;
  q[kGrinderC] = c;
  q[kGrinderA] = a;
  return q;
}

}  // namespace volcomp
