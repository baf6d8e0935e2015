// Cases of docs/papers/xyfz.md: exact and first-order volumetric errors of the XYFZ machine and of
// generic chains.

#include "comp/metrology/tables/abbe.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/xyfz_case.hpp"

namespace volcomp::cases {
namespace {

std::array<ErrorMotion, 3> relative_errors(const json& err_rel) {
  return {six(err_rel.at("X")), six(err_rel.at("Y")), six(err_rel.at("Z"))};
}

// Functional point seen from the reading head of an axis: tool point − frame origin, ideal chain.
Vec3 arm(const MachineChain& chain, const Pose& q, const BodyPath& path, std::uint8_t wanted) {
  Frame frame;
  for (const std::uint8_t body : path) {
    const Joint& joint = chain.joint(body);
    frame = frame * joint_offset(joint) * joint_motion(joint, q[joint.nc_axis]);
    if (body == wanted) break;
  }
  return chain.ideal(chain.tool(), q).apply(chain.tool_point()) - frame.t;
}

json volumetric_optimised(const json& in) {
  const MachineChain chain = chain_of(xyfz_optimised(offsets_of(in)));
  const Pose q = pose_of(vector3(in.at("q")));
  const ErrorSet errors = internal_errors(chain, relative_errors(in.at("err_rel")), q);
  const Vec3 C =
      squareness_translation(chain, q, xyfz_directions(squareness_of(in.at("a_xy_xz_yz"))));
  const PointPair points = ideal_points(chain, q, chain.tool_point());
  const VolumetricError rot = exact_error(chain, q, errors, C, RotationModel::exponential, points);
  const VolumetricError small = exact_error(chain, q, errors, C, RotationModel::linear, points);
  json arms = json::array();
  for (std::size_t a = 0; a < 3; ++a) {
    arms.push_back(
        to_json(arm(chain, q, a == 2 ? chain.tool() : chain.work(), chain.body_of_axis(a))));
  }
  return {{"arms", arms},
          {"C", to_json(C)},
          {"first_order", to_json(first_order_error(chain, q, errors, C, points).position_base)},
          {"eq11_13_small_base", to_json(small.position_base)},
          {"rot_base", to_json(rot.position_base)},
          {"rot_workpiece", to_json(rot.position_work)}};
}

json volumetric_naive(const json& in) {
  const MachineChain chain =
      chain_of(xyfz_naive(squareness_of(in.at("a_xy_xz_yz")), array3(in.at("pt"))));
  const Pose q = pose_of(vector3(in.at("q")));
  const ErrorSet errors = internal_errors(chain, relative_errors(in.at("err_rel")), q);
  const Vec3 none = Vec3::Zero();
  const PointPair tracking = ideal_points(chain, q, chain.tool_point());
  const PointPair zero{Vec3::Zero(), Vec3::Zero()};
  const auto small = [&](const PointPair& p) {
    return to_json(exact_error(chain, q, errors, none, RotationModel::linear, p).position_base);
  };
  const auto first = [&](const PointPair& p) {
    return to_json(first_order_error(chain, q, errors, none, p).position_base);
  };
  return {{"eq1_3_small_tracking", small(tracking)},
          {"first_order_tracking", first(tracking)},
          {"eq1_3_small_zero", small(zero)},
          {"first_order_zero", first(zero)}};
}

// Body 1 is the base; every branch hangs on it in the order in which the case lists its joints.
MachineDescription description_of(const json& in) {
  MachineDescription d;
  d.body_count = 1;
  d.work_body = d.tool_body = 1;
  d.tool_point = array3(in.at("pt"));
  for (const json& j : in.at("joints")) {
    const bool tool = j.at("branch") == "t";
    std::uint8_t& tip = tool ? d.tool_body : d.work_body;
    Body& body = d.body.at(d.body_count);
    body.lower = tip;
    body.joint.kind = j.at("kind") == "R" ? JointKind::rotary : JointKind::prismatic;
    body.joint.letter = j.at("axis").get<std::string>().at(0);
    body.joint.axis = static_cast<Axis>(body.joint.letter - 'X');
    body.joint.sign = j.at("sign").get<std::int8_t>();
    body.joint.nc_axis = static_cast<std::uint8_t>(d.body_count - 1U);
    body.joint.offset = array3(j.at("off"));
    tip = ++d.body_count;
  }
  return d;
}

json generic_chain(const json& in) {
  const MachineChain chain = chain_of(description_of(in));
  Pose q{};
  ErrorSet errors = zero_errors();
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    q[a] = number(in.at("q").at(a));
    errors[a] = to_internal(six(in.at("err_rel").at(a)), chain.axis(a), q[a], Convention::relative,
                            Side::moving);
  }
  const Vec3 none = Vec3::Zero();
  const PointPair points = ideal_points(chain, q, chain.tool_point());
  const VolumetricError first = first_order_error(chain, q, errors, none, points);
  const VolumetricError small = exact_error(chain, q, errors, none, RotationModel::linear, points);
  const VolumetricError exact =
      exact_error(chain, q, errors, none, RotationModel::exponential, points);
  return {{"first_order_base", to_json(first.position_base)},
          {"first_order_workpiece", to_json(first.position_work)},
          {"small_base", to_json(small.position_base)},
          {"small_workpiece", to_json(small.position_work)},
          {"exp_base", to_json(exact.position_base)},
          {"exp_workpiece", to_json(exact.position_work)}};
}

json abbe_transfer(const json& in) {
  const auto axis = static_cast<Axis>(in.at("axis").get<std::string>().at(0) - 'X');
  const double q = number(in.at("q"));
  const int kappa = in.at("kappa").get<int>();
  const SensedPoint first{vector3(in.at("L0")), kappa};
  const SensedPoint second{vector3(in.at("L0_second")), kappa};
  const ErrorMotion head = six(in.at("e_head"));
  const ErrorMotion measured = at_lever(head, first.lever(axis, q));
  return {{"L", to_json(first.lever(axis, q))},
          {"e_meas", to_json(measured)},
          {"e_head_from_meas", to_json(at_head(measured, first.lever(axis, q)))},
          {"e_meas_second", to_json(at_lever(head, second.lever(axis, q)))}};
}

}  // namespace

void add_s1_geometry(Handlers& handlers) {
  handlers["s1.volumetric_optimised"] = volumetric_optimised;
  handlers["s1.volumetric_naive"] = volumetric_naive;
  handlers["s1.generic_chain"] = generic_chain;
  handlers["s1.abbe_transfer"] = abbe_transfer;
}

}  // namespace volcomp::cases
