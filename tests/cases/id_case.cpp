#include "tests/cases/id_case.hpp"

#include "host_sim/host/measure/identify/chain_geometry.hpp"

namespace volcomp::cases {

using namespace host::identify;

namespace {

[[noreturn]] void refuse_with(Reason reason, const json& where) {
  throw Refused(refuse(reason), where);
}

std::size_t channel_of(const json& name) {
  for (std::size_t c = 0; c < kChannelNames.size(); ++c)
    if (name == kChannelNames.at(c)) return c;
  throw std::runtime_error("channel " + name.dump());
}

Channels channels_of(const json& names) {
  Channels out;
  for (const json& name : names)
    out.push_back(channel_of(name));
  return out;
}

std::size_t axis_of(const Machine& machine, const std::string& name, const char* field) {
  for (std::size_t a = 0; a < machine.chain.axis_count(); ++a)
    if (machine.name_of(a) == name) return a;
  refuse_with(Reason::unknown_reference, {{"field", field}, {"axis", name}});
}

// A scale or a prior: absent, "free" or a standard uncertainty.
Prior prior_of(const json& in, const char* field) {
  if (!in.contains(field)) return std::nullopt;
  return in[field] == "free" ? kFree : number(in[field]);
}

std::vector<std::size_t> indices_of(const json& in, std::size_t count) {
  if (in.is_number()) return std::vector<std::size_t>(count, in.get<std::size_t>());
  return in.get<std::vector<std::size_t>>();
}

Joint joint_of(const json& in, std::size_t nc_axis) {
  Joint joint;
  joint.kind = in.at("kind") == "R" ? JointKind::rotary : JointKind::prismatic;
  joint.axis = static_cast<Axis>(in.at("axis").get<int>());
  joint.sign = static_cast<std::int8_t>(in.at("sign").get<int>());
  joint.nc_axis = static_cast<std::uint8_t>(nc_axis);
  joint.letter = in.at("name").get<std::string>().at(0);
  joint.offset = array3(in.at("off"));
  if (!in.contains("R")) return joint;
  const json flat =
      in["R"].at(0).is_array()
          ? json::array({in["R"][0][0], in["R"][0][1], in["R"][0][2], in["R"][1][0], in["R"][1][1],
                         in["R"][1][2], in["R"][2][0], in["R"][2][1], in["R"][2][2]})
          : in["R"];
  for (std::size_t i = 0; i < 9; ++i)
    joint.orientation.at(i) = number(flat[i]);
  return joint;
}

ErrorModel model_of(const Machine& machine, const json& in) {
  ErrorModel model;
  const Channels all{0, 1, 2, 3, 4, 5};
  for (const auto& [name, f] : in.at("functions").items()) {
    AxisFunctions& axis = model.functions.at(axis_of(machine, name, "functions"));
    axis.segments = f.at("segments").get<std::size_t>();
    axis.channels = f.contains("channels") ? channels_of(f["channels"]) : all;
    if (!f.contains("reversal")) continue;
    axis.reversal =
        f.contains("reversal_channels") ? channels_of(f["reversal_channels"]) : axis.channels;
  }
  for (const char* field : {"location", "constant"}) {
    if (!in.contains(field)) continue;
    auto& where = std::string(field) == "location" ? model.location : model.constant;
    for (const auto& [name, channels] : in[field].items())
      where.at(axis_of(machine, name, field)) = channels_of(channels);
  }
  for (const json& row : in.value("gauge", json::array()))
    model.gauge.push_back({axis_of(machine, row.at(0), "gauge"), channel_of(row.at(1))});
  if (in.contains("curvature") && !in["curvature"].is_null())
    model.curvature = Curvature{number(in["curvature"].at(0)), number(in["curvature"].at(1))};
  return model;
}

Artefact artefact_of(const json& in) {
  Artefact a;
  a.name = in.at("name");
  for (const json& c : in.at("spheres"))
    a.spheres.push_back(vector3(c));
  if (in.contains("radius"))
    a.radius = in["radius"].is_array()
                   ? numbers(in["radius"])
                   : std::vector<double>(a.spheres.size(), number(in["radius"]));
  const std::string known = in.value("known", "fixed");
  if (known == "free") a.place = kFree;
  if (known == "prior") a.place = number(in.at("sigma"));
  a.scale = prior_of(in, "scale");
  for (const json& l : in.value("lengths", json::array()))
    a.lengths.push_back({l.at("a"), l.at("b"), number(l.at("length")), number(l.at("sigma"))});
  return a;
}

// One number, one an observation, one a component, or a row an observation.
std::vector<double> sigmas_of(const json& in, std::size_t count, std::size_t components) {
  std::vector<double> sigma;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < components; ++k) {
      const json* value = &in;
      if (in.is_array() && components > 1 && !in.at(0).is_array())
        value = &in.at(k);
      else if (in.is_array())
        value = &in.at(i);
      sigma.push_back(number(value->is_array() ? value->at(k) : *value));
    }
  }
  return sigma;
}

Directions directions_of(const json& in) {
  Directions d{};
  for (std::size_t a = 0; a < in.size(); ++a)
    d.at(a) = number(in[a]);
  return d;
}

void read_positions(const json& in, SetUp& s) {
  const bool runs = s.kind == ObservationKind::runs;
  for (const json& q : in.at("q")) {
    Pose pose{};
    if (runs) pose.at(s.axis) = number(q);
    s.q.push_back(runs ? pose : pose_of(q));
  }
  if (!in.contains("d")) s.d.assign(s.q.size(), {});
  for (const json& d : in.value("d", json::array())) {
    Directions directions{};
    if (runs) directions.at(s.axis) = number(d);
    s.d.push_back(runs ? directions : directions_of(d));
  }
}

void read_readings(const json& in, SetUp& s) {
  for (const json& y : in.value("y", json::array())) {
    if (y.is_array()) {
      for (const json& component : y)
        s.y.push_back(number(component));
    } else {
      s.y.push_back(number(y));
    }
  }
}

void require_fields(const json& in) {
  for (const char* field : {"name", "kind", "q", "sigma"})
    if (!in.contains(field))
      refuse_with(Reason::missing_field, {{"field", field}, {"setup", in.value("name", "")}});
}

ObservationKind kind_of(const json& in) {
  for (std::size_t k = 0; k < kKindNames.size(); ++k)
    if (in.at("kind") == kKindNames.at(k)) return static_cast<ObservationKind>(k);
  refuse_with(Reason::unknown_kind, {{"setup", in.at("name")}});
}

}  // namespace

Pose pose_of(const json& in) {
  Pose q{};
  for (std::size_t a = 0; a < in.size(); ++a)
    q.at(a) = number(in[a]);
  return q;
}

std::vector<Pose> poses_of(const json& in) {
  std::vector<Pose> out;
  for (const json& q : in)
    out.push_back(pose_of(q));
  return out;
}

ErrorSet errors_of(const json& in) {
  ErrorSet errors = zero_errors();
  for (std::size_t a = 0; a < in.size(); ++a)
    errors.at(a) = six(in[a]);
  return errors;
}

Machine machine_of(const json& in) {
  MachineDescription d;
  d.body_count = 1;
  d.work_body = d.tool_body = 1;
  std::size_t axis = 0;
  for (const json& joint : in.at("joints")) {
    std::uint8_t& tip = joint.at("branch") == "w" ? d.work_body : d.tool_body;
    Body& body = d.body.at(d.body_count);
    body.lower = tip;
    body.joint = joint_of(joint, axis++);
    tip = ++d.body_count;
  }
  d.tool_point = array3(in.at("tool"));
  Machine machine;
  require(MachineChain::build(d, machine.chain));
  for (std::size_t a = 0; a < axis; ++a) {
    const json& joint = in["joints"][a];
    machine.travel.at(a) = {number(joint.at("lo")), number(joint.at("hi")), number(joint.at("ref")),
                            joint.value("periodic", false)};
  }
  return machine;
}

Stylus stylus_of(const json& in) {
  Stylus s;
  s.name = in.at("name");
  s.offset = vector3(in.at("offset"));
  s.radius = number(in.at("radius"));
  if (!in.value("fixed", false)) s.place = in.contains("sigma") ? number(in["sigma"]) : kFree;
  if (in.value("radius_unknown", false))
    s.radius_prior = in.contains("radius_sigma") ? number(in["radius_sigma"]) : kFree;
  return s;
}

SetUp setup_of(const Machine& machine, const json& in) {
  require_fields(in);
  SetUp s;
  s.name = in.at("name");
  s.kind = kind_of(in);
  if (s.kind == ObservationKind::runs) {
    s.axis = axis_of(machine, in.at("axis"), "axis");
    s.channels = channels_of(in.at("channels"));
    s.lever = vector3(in.at("L0"));
    s.kappa = number(in.at("kappa"));
    s.slopes = in.value("slopes", true);
  }
  read_positions(in, s);
  read_readings(in, s);
  s.sigma = sigmas_of(in.at("sigma"), s.q.size(), s.components());
  s.scale = prior_of(in, "scale");
  if (in.contains("stylus")) s.stylus = indices_of(in["stylus"], s.q.size());
  if (in.contains("station")) s.station = vector3(in["station"]);
  s.in_bed = in.value("frame", "work") == "bed";
  if (in.contains("length")) s.length = number(in["length"]);
  if (in.contains("length_sigma")) s.length_prior = number(in["length_sigma"]);
  if (in.contains("normal")) s.normal = vector3(in["normal"]);
  if (in.contains("u")) s.along = vector3(in["u"]);
  if (in.contains("beam")) s.beam = vector3(in["beam"]);
  if (in.contains("mirror")) s.mirror = vector3(in["mirror"]);
  if (in.contains("artefact")) s.artefact = in["artefact"].get<std::size_t>();
  if (in.contains("sphere")) s.sphere = indices_of(in["sphere"], s.q.size());
  if (in.contains("pose")) {
    const std::vector<double> p = numbers(in["pose"]);
    s.pose = Placement{exponential({p.at(0), p.at(1), p.at(2)}), {p.at(3), p.at(4), p.at(5)}};
  }
  return s;
}

Problem problem_of(const json& in) {
  for (const char* field : {"machine", "model", "styli", "setups"})
    if (!in.contains(field)) refuse_with(Reason::missing_field, {{"field", field}});
  Problem problem;
  problem.machine = machine_of(in["machine"]);
  problem.model = model_of(problem.machine, in["model"]);
  for (const json& s : in["styli"])
    problem.styli.push_back(stylus_of(s));
  for (const json& a : in.value("artefacts", json::array()))
    problem.artefacts.push_back(artefact_of(a));
  for (const json& s : in["setups"])
    problem.setups.push_back(setup_of(problem.machine, s));
  return problem;
}

}  // namespace volcomp::cases
