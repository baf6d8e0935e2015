#pragma once
// What three linear axes have to do about an error of the exact chain.

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {

// Columns of J = ∂p/∂q of three linear axes that nothing turns: the ideal chain with 1 mm of motion
// of one axis, seen as an error of it.
inline std::array<Real3, 3> jacobian(const MachineDescription& d) {
  constexpr float kStep_nm = 1e6F;
  MachineTables ideal;
  ideal.machine = d;
  for (Body& body : ideal.machine.body)
    body.constant_error = {};
  for (AxisTable& axis : ideal.axis)
    axis.knots = 2;
  std::array<Real3, 3> column{};
  for (std::size_t c = 0; c < 3; ++c) {
    MachineTables moved = ideal;
    for (std::size_t k = 0; k < d.body_count; ++k) {
      const Joint& joint = d.body[k].joint;
      if (!joint.moves() || joint.nc_axis != d.correcting[c]) continue;
      for (Channels& knot : moved.axis[joint.nc_axis].value[0])
        knot[index(joint.axis)] = kStep_nm * static_cast<float>(joint.sign);
    }
    MachineModel model(moved, d.tool_point);
    model.stand_at({}, {});
    column[c] = model.exact();
    for (Real& v : column[c])
      v /= static_cast<Real>(kStep_nm);
  }
  return column;
}

// Offsets that cancel `e`, by Cramer's rule.
inline Real3 cancelling(const std::array<Real3, 3>& J, const Real3& e) {
  const auto det = [](const Real3& a, const Real3& b, const Real3& g) {
    return a[0] * (b[1] * g[2] - b[2] * g[1]) - b[0] * (a[1] * g[2] - a[2] * g[1]) +
           g[0] * (a[1] * b[2] - a[2] * b[1]);
  };
  const Real whole = det(J[0], J[1], J[2]);
  return {-det(e, J[1], J[2]) / whole, -det(J[0], e, J[2]) / whole, -det(J[0], J[1], e) / whole};
}

}  // namespace volcomp::test
