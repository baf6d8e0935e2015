#include "tests/cases/xyfz_case.hpp"

namespace volcomp::cases {

XyfzOffsets offsets_of(const json& in) {
  return {array3(in.at("b12")), array3(in.at("b03")), array3(in.at("pt"))};
}

XyfzSquareness squareness_of(const json& a) {
  return {number(a.at(0)), number(a.at(1)), number(a.at(2))};
}

MachineChain chain_of(const MachineDescription& description) {
  MachineChain chain;
  require(MachineChain::build(description, chain));
  return chain;
}

Pose pose_of(const Vec3& q) {
  Pose pose{};
  for (std::size_t i = 0; i < 3; ++i)
    pose[i] = q(static_cast<Eigen::Index>(i));
  return pose;
}

ErrorSet internal_errors(const MachineChain& chain, const std::array<ErrorMotion, 3>& relative,
                         const Pose& q) {
  ErrorSet errors = zero_errors();
  for (std::size_t a = 0; a < 3; ++a) {
    errors[a] = to_internal(relative[a], chain.axis(a), q[a], Convention::relative, Side::moving);
  }
  return errors;
}

ErrorTable table_of(const json& table) {
  ErrorTable t;
  t.q0 = number(table.at("q0"));
  t.pitch = number(table.at("h"));
  t.knots = table.at("f").size();
  for (std::size_t i = 0; i < t.knots && i < kTableKnots; ++i)
    t.forward[i] = t.backward[i] = six(table["f"][i]);
  return t;
}

XyfzCase::XyfzCase(const json& in) {
  const bool has_squareness = in.contains("a_xy_xz_yz");
  model.chain = chain_of(xyfz_optimised(offsets_of(in)));
  model.tool_point = vector3(in.at("pt"));
  if (has_squareness) model.directions = xyfz_directions(squareness_of(in["a_xy_xz_yz"]));
  for (std::size_t a = 0; a < 3; ++a) {
    relative[a] = internal[a] = table_of(in.at("tables").at(a));
    convert_to_internal(model.chain.axis(a), Convention::relative, Side::moving, internal[a]);
    model.table[a] = &internal[a];
  }
}

Vec3 XyfzCase::error(const Vec3& q) const {
  return model.first_order(pose_of(q), kUnknownTravels, Beyond::lever_as_given);
}

}  // namespace volcomp::cases
