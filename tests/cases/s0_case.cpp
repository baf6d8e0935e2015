#include "tests/cases/s0_case.hpp"

#include <algorithm>

namespace volcomp::cases {

Mat3 matrix(const json& rows) {
  Mat3 m;
  for (Eigen::Index i = 0; i < 3; ++i)
    m.row(i) = vector3(rows.at(static_cast<std::size_t>(i))).transpose();
  return m;
}

json rows_of(const Mat3& m) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < 3; ++i)
    rows.push_back(to_json(Vec3(m.row(i).transpose())));
  return rows;
}

Joint joint_of(const json& in) {
  Joint joint;
  joint.kind = in.at("kind") == "R" ? JointKind::rotary : JointKind::prismatic;
  joint.letter = in.at("axis").get<std::string>().at(0);
  joint.axis = static_cast<Axis>(joint.letter - 'X');
  joint.sign = in.at("sign").get<double>() < 0.0 ? -1 : 1;
  const Mat3 R = matrix(in.at("R"));
  for (Eigen::Index i = 0; i < 9; ++i)
    joint.orientation[static_cast<std::size_t>(i)] = R(i / 3, i % 3);
  joint.offset = array3(in.at("t"));
  return joint;
}

InvoluteGear gear_of(const json& in) {
  InvoluteGear gear;
  gear.teeth = in.at("z").get<int>();
  gear.module = number(in.at("m"));
  gear.pressure_angle = number(in.at("alpha"));
  gear.tip_diameter = number(in.at("d_a"));
  gear.width = number(in.at("b"));
  require(derive(gear));
  return gear;
}

Flank flank_of(const json& in) {
  return {in.at("side").get<int>() > 0 ? FlankSide::left : FlankSide::right,
          in.at("tooth").get<int>()};
}

ErrorMotion interpolate_motion(Span<const double> nodes, Span<const ErrorMotion> motion, double q,
                               bool& held) {
  const std::size_t last = nodes.size() - 1;
  held = q < nodes[0] || q > nodes[last];
  if (!(q > nodes[0])) return motion[0];
  if (!(q < nodes[last])) return motion[last];
  const double* const above = std::upper_bound(nodes.begin(), nodes.end(), q);
  const auto i = static_cast<std::size_t>(above - nodes.begin()) - 1;
  const double t = (q - nodes[i]) / (nodes[i + 1] - nodes[i]);
  return motion[i] + t * (motion[i + 1] - motion[i]);
}

L300gCase::L300gCase(const json& in)
    : arm{number(in.at("LR")), number(in.at("Bc"))},
      datum{number(in.at("X0")), number(in.at("Y0"))} {
  require(MachineChain::build(test::l300g_machine(arm, datum), chain));
}

}  // namespace volcomp::cases
