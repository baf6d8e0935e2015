// Cases of docs/papers/l300g.md: error chains of probe and work branch, the arm, the stylus.

#include "comp/metrology/gears/gear_path.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s0_case.hpp"
#include "tests/oracle/axis_identification.hpp"
#include "tests/oracle/stylus.hpp"

namespace volcomp::cases {
namespace {

// --- chains

// Body 1 is the base; the probe branch comes first, then the work branch.
struct Chain {
  explicit Chain(const json& in) {
    MachineDescription d;
    d.body_count = d.work_body = d.tool_body = 1;
    d.tool_point = array3(in.at("tip"));
    add(d, d.tool_body, in.at("probe"), in.at("q_probe"), in.at("err_probe"));
    probe_axes = d.body_count - 1U;
    add(d, d.work_body, in.at("work"), in.at("q_work"), in.at("err_work"));
    require(MachineChain::build(d, chain));
  }

  void add(MachineDescription& d, std::uint8_t& tip, const json& joints, const json& at,
           const json& motions) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const std::size_t axis = d.body_count - 1U;
      Body& body = d.body.at(d.body_count);
      body.lower = tip;
      body.joint = joint_of(joints.at(i));
      body.joint.nc_axis = static_cast<std::uint8_t>(axis);
      q.at(axis) = number(at.at(i));
      errors.at(axis) = six(motions.at(i));
      tip = ++d.body_count;
    }
  }

  [[nodiscard]] VolumetricError exact(RotationModel model, const ErrorSet& set) const {
    return exact_error(chain, q, set, Vec3::Zero(), model, points());
  }
  [[nodiscard]] PointPair points() const { return ideal_points(chain, q, chain.tool_point()); }
  // The probe branch alone.
  [[nodiscard]] ErrorSet probe_errors() const {
    ErrorSet set = zero_errors();
    for (std::size_t a = 0; a < probe_axes; ++a)
      set[a] = errors[a];
    return set;
  }

  MachineChain chain;
  std::size_t probe_axes = 0;
  Pose q{};
  ErrorSet errors = zero_errors();
};

json htm_chain(const json& in) {
  const Chain c(in);
  const Vec3 ideal = c.chain.ideal(c.chain.tool(), c.q).apply(c.chain.tool_point());
  const Vec3 base = c.exact(RotationModel::rxryrz, c.probe_errors()).position_base;
  const Vec3 small = c.exact(RotationModel::linear, c.probe_errors()).position_base;
  const Vec3 work = c.exact(RotationModel::rxryrz, c.errors).position_work;
  const Vec3 ideal_work = c.points().work;
  return {{"tip_base_ideal", to_json(ideal)},
          {"tip_base_actual", to_json(Vec3(ideal + base))},
          {"tip_base_actual_linrot", to_json(Vec3(ideal + small))},
          {"dev_base", to_json(base)},
          {"tip_work_ideal", to_json(ideal_work)},
          {"tip_work_actual", to_json(Vec3(ideal_work + work))},
          {"dev_work", to_json(work)}};
}

json first_order(const json& in) {
  const Chain c(in);
  const Vec3 none = Vec3::Zero();
  const auto first = [&](const ErrorSet& set) {
    return first_order_error(c.chain, c.q, set, none, c.points());
  };
  return {{"first_order_base", to_json(first(c.probe_errors()).position_base)},
          {"first_order_work", to_json(first(c.errors).position_work)},
          {"exact_base", to_json(c.exact(RotationModel::rxryrz, c.probe_errors()).position_base)},
          {"exact_work", to_json(c.exact(RotationModel::rxryrz, c.errors).position_work)}};
}

json transform(const Mat3& R, const Vec3& t) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < 3; ++i)
    rows.push_back({R(i, 0), R(i, 1), R(i, 2), t(i)});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

json htm_eq2(const json& in) {
  const Vec3 angles(number(in.at("a")), number(in.at("b")), number(in.at("c")));
  const Vec3 t(number(in.at("x")), number(in.at("y")), number(in.at("z")));
  const Mat3 R = axis_rotation(Axis::x, angles.x()) * axis_rotation(Axis::y, angles.y()) *
                 axis_rotation(Axis::z, angles.z());
  const Mat3 linear = Mat3::Identity() + rotation_minus_identity(RotationModel::linear, angles);
  return {{"T", transform(R, t)},
          {"T_linear", transform(linear, t)},
          {"R_minus_I", rows_of(rotation_minus_identity(RotationModel::rxryrz, angles))}};
}

// --- arm and stylus

SwingArm arm_of(const json& in) { return {number(in.at("LR")), number(in.at("Bc"))}; }

json arc(const json& in) {
  const SwingArm arm = arm_of(in);
  double B = 0.0;
  if (!in.contains("B")) {
    require(arm_angle(arm, number(in.at("Z")), B));
    return {{"B_from_Z", B}};
  }
  const double given = number(in.at("B"));
  const double height = test::arm_height(arm, given);
  require(arm_angle(arm, height, B));
  return {{"Z", height},
          {"dX", arm_foreshortening(arm, given)},
          {"dZ_dB", arm_lift(arm, given)},
          {"B_from_Z", B}};
}

json stylus(const json& in) {
  Vec3 contact;
  require(test::contact_point(vector3(in.at("centre")), vector3(in.at("normal")),
                              number(in.at("r_c")), contact));
  return {{"contact", to_json(contact)}};
}

json motion_comp(const json& in) {
  test::ArmOffset offset;
  require(test::arm_offset(arm_of(in), number(in.at("B")), vector3(in.at("error_base")), offset));
  return {{"dX", offset.X}, {"dY", offset.Y}, {"dB", offset.B}};
}

json table_interp(const json& in) {
  const std::vector<double> nodes = numbers(in.at("nodes"));
  std::vector<ErrorMotion> values;
  for (const json& v : in.at("values"))
    values.push_back(six(v));
  bool held = false;
  const ErrorMotion value = interpolate_motion(nodes, values, number(in.at("q")), held);
  return {{"value", to_json(value)}, {"clamped", held}};
}

json nominal_pose(const json& in) {
  const L300gCase machine(in.at("machine"));
  const InvoluteGear gear = gear_of(in.at("gear"));
  const FlankTouch touch{flank_of(in), number(in.at("roll_length")), number(in.at("x"))};
  const PathStyle style = in.at("path") == "generate" ? PathStyle::generate : PathStyle::fixed_a;
  Pose q{};
  require(touch_pose(machine.arm, machine.datum, gear, style, touch, number(in.at("r_c")), q));
  return {{"X", q[0]}, {"Y", q[1]}, {"B", q[2]}, {"A", q[3]}};
}

}  // namespace

void add_s0_geometry(Handlers& handlers) {
  handlers["s0.htm_chain"] = htm_chain;
  handlers["s0.first_order"] = first_order;
  handlers["s0.htm_eq2"] = htm_eq2;
  handlers["s0.arc"] = arc;
  handlers["s0.stylus"] = stylus;
  handlers["s0.motion_comp"] = motion_comp;
  handlers["s0.table_interp"] = table_interp;
  handlers["s0.nominal_pose"] = nominal_pose;
}

}  // namespace volcomp::cases
