#include "comp/machine/xyfz.hpp"

namespace volcomp {

MachineDescription xyfz_naive(const XyfzSquareness& squareness,
                              const std::array<double, 3>& tool_point) {
  const MachineDescription full = xyfz_optimised({{}, {}, tool_point});
  MachineDescription d = full;
  d.body_count = 7;
  d.body[1] = full.body[1];  // Y on the bed
  d.body[2].lower = 2;       // C_xy on Y
  d.body[2].joint = {};
  d.body[2].constant_error = {0, 0, 0, 0, 0, squareness.a_xy};
  d.body[3] = full.body[2];  // X on C_xy
  d.body[3].lower = 3;
  d.body[4].lower = 1;  // C_yz on the bed
  d.body[4].constant_error = {0, 0, 0, squareness.a_yz, 0, 0};
  d.body[5].lower = 5;  // C_xz on C_yz
  d.body[5].constant_error = {0, 0, 0, 0, squareness.a_xz, 0};
  d.body[6] = full.body[3];  // Z on C_xz
  d.body[6].lower = 6;
  d.work_body = 4;
  d.tool_body = 7;
  return d;
}

DirectionErrors xyfz_directions(const XyfzSquareness& squareness) {
  DirectionErrors directions = zero_directions();
  directions[0] = Vec3(0.0, squareness.a_xy, 0.0);
  directions[2] = Vec3(squareness.a_xz, -squareness.a_yz, 0.0);
  return directions;
}

}  // namespace volcomp
