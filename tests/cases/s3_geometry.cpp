// Cases of docs/papers/internal-helical.md: lower-body arrays, error chains, wheel profiles,
// contact lines.

#include <algorithm>

#include "comp/metrology/gears/contact_line.hpp"
#include "comp/metrology/tables/left_error.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s0_case.hpp"
#include "tests/cases/s3_case.hpp"

namespace volcomp::cases {
namespace {

// --- lower-body arrays

json numbered(const BodyPath& path) {
  json list = json::array();
  for (const std::uint8_t body : path)
    list.push_back(body + 1);
  return list;
}

// L⁰, L¹, … up to and including the first row of zeros.
json lower_rows(const std::vector<std::uint8_t>& parent) {
  std::vector<int> row;
  for (std::size_t k = 0; k < parent.size(); ++k)
    row.push_back(static_cast<int>(k) + 1);
  json rows = json::array({row});
  while (std::any_of(row.begin(), row.end(), [](int body) { return body != 0; })) {
    for (int& body : row)
      body = body == 0 ? 0 : parent[static_cast<std::size_t>(body) - 1];
    rows.push_back(row);
  }
  return rows;
}

json lower_body(const json& in) {
  const auto parent = in.at("parent").get<std::vector<std::uint8_t>>();
  require(check_lower_body({parent.data(), parent.size()}));
  MachineDescription d;
  d.body_count = static_cast<std::uint8_t>(parent.size());
  for (std::size_t k = 0; k < parent.size(); ++k)
    d.body.at(k).lower = parent[k];
  d.work_body = in.at("g").get<std::uint8_t>();
  d.tool_body = in.at("W").get<std::uint8_t>();
  MachineChain chain;
  require(MachineChain::build(d, chain));
  const BodyPath to_gear = path_to_root(d, d.work_body);
  const BodyPath to_wheel = path_to_root(d, d.tool_body);
  const std::size_t common = common_bodies(to_gear, to_wheel);
  return {
      {"rows", lower_rows(parent)},         {"path_g", numbered(to_gear)},
      {"path_W", numbered(to_wheel)},       {"common", to_gear.body[to_gear.count - common] + 1},
      {"branch_g", numbered(chain.work())}, {"branch_W", numbered(chain.tool())}};
}

// --- chains

Joint joint_with_offset(const json& in) {
  Joint joint;
  const std::string kind = in.at("kind");
  joint.kind = kind == "R"   ? JointKind::rotary
               : kind == "P" ? JointKind::prismatic
                             : JointKind::fixed;
  joint.letter = in.at("axis").get<std::string>().at(0);
  joint.axis = static_cast<Axis>(joint.letter - 'X');
  joint.sign = in.at("sign").get<double>() < 0.0 ? -1 : 1;
  const json& offset = in.at("offset");
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      joint.orientation[3 * i + k] = number(offset.at(i).at(k));
    joint.offset[i] = number(offset.at(i).at(3));
  }
  return joint;
}

// Body 1 is the base.
struct Grinder {
  explicit Grinder(const json& in) {
    MachineDescription d;
    d.body_count = d.work_body = d.tool_body = 1;
    add(d, d.work_body, in.at("work"));
    add(d, d.tool_body, in.at("tool"));
    require(MachineChain::build(d, chain));
  }

  void add(MachineDescription& d, std::uint8_t& tip, const json& joints) {
    for (const json& joint : joints) {
      Body& body = d.body.at(d.body_count);
      body.lower = tip;
      body.joint = joint_with_offset(joint);
      const ErrorMotion e = six(joint.at("e"));
      if (body.joint.moves()) {
        body.joint.nc_axis = static_cast<std::uint8_t>(axes);
        q.at(axes) = number(joint.at("q"));
        errors.at(axes++) = e;
      } else {
        Eigen::Map<ErrorMotion>(body.constant_error.data()) = e;
      }
      tip = ++d.body_count;
    }
  }

  MachineChain chain;
  std::size_t axes = 0;
  Pose q{};
  ErrorSet errors = zero_errors();
};

json four_by_four(const Frame& frame) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < 3; ++i)
    rows.push_back({frame.R(i, 0), frame.R(i, 1), frame.R(i, 2), frame.t(i)});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

json chain(const json& in) {
  const Grinder g(in);
  const LeftError first = left_error(g.chain, g.q, g.errors);
  const auto actual = [&](RotationModel model) {
    return four_by_four(actual_tool_in_work(g.chain, g.q, g.errors, model));
  };
  return {{"T_gW", four_by_four(tool_in_work(g.chain, g.q))},
          {"T_gW_e_exact", actual(RotationModel::exponential)},
          {"T_gW_e_printed", actual(RotationModel::linear)},
          {"delta", to_json(first.delta)},
          {"eps", to_json(first.eps)},
          {"vol", to_json(first.at(vector3(in.at("point_g"))))}};
}

// --- wheel and contact

json wheel_profile_points(const json& in) {
  const InternalGear gear = internal_gear_of(in.at("gear"));
  json points = json::array();
  for (const json& radius : in.at("r")) {
    WheelContact c;
    require(wheel_contact(gear, setup_of(in), side_of(in), number(radius), c));
    points.push_back({{"th", c.flank.P.z() * gear.turn_per_mm},
                      {"z", c.flank.P.z()},
                      {"rho", c.rho},
                      {"y", c.y},
                      {"dy_drho", c.slope},
                      {"phi", c.phi},
                      {"P", to_json(c.flank.P)},
                      {"n", to_json(c.flank.n)}});
  }
  return {{"points", points}};
}

json contact_line(const json& in) {
  const WheelGeneration generation{setup_of(in), 1.0 / number(in.at("p"))};
  const json& window = in.at("phi_window");
  GeneratedPoint g;
  require(generated_point(generation, number(in.at("rho")),
                          {number(in.at("y")), number(in.at("dy_drho"))},
                          {number(window.at(0)), number(window.at(1))}, g));
  return {{"phi", g.phi}, {"r_g", to_json(g.point)}, {"n_g_out_of_wheel", to_json(g.normal)}};
}

}  // namespace

void add_s3_geometry(Handlers& handlers) {
  handlers["s3.lower_body"] = lower_body;
  handlers["s3.chain"] = chain;
  handlers["s3.wheel_profile"] = wheel_profile_points;
  handlers["s3.contact_line"] = contact_line;
}

}  // namespace volcomp::cases
