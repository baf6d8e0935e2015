#include "host_sim/machine/machine_file.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include "comp/tables/plausibility.hpp"
#include "host_sim/data/toml_section.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

using Section = TomlSection;

char letter_of(const Section& section, const std::string& key) {
  const std::string name = section.text(key);
  if (name.size() != 1 || std::string("XYZABCUVW").find(name[0]) == std::string::npos) {
    section.complain(key, fmt::format("'{}' must be one of X Y Z A B C U V W", key));
  }
  return name[0];
}

AxisFile read_axis(const Section& s) {
  s.allow_only({"name", "travel_mm", "travel_rad", "targets", "reference_mm", "reference_rad",
                "sensed_point_mm", "kappa"});
  AxisFile axis;
  axis.letter = letter_of(s, "name");
  const bool rotary = s.has("travel_rad");
  const std::string travel_key = rotary ? "travel_rad" : "travel_mm";
  const auto travel = s.numbers<2>(travel_key);
  axis.lo = travel[0];
  axis.hi = travel[1];
  if (!(axis.lo < axis.hi))
    s.complain(travel_key, fmt::format("'{}' must be [low, high]", travel_key));
  axis.targets =
      static_cast<std::size_t>(s.integer_or("targets", 11, 2, static_cast<long>(kTableKnots)));
  const std::string reference_key = rotary ? "reference_rad" : "reference_mm";
  axis.reference = s.number(reference_key);
  if (axis.reference < axis.lo || axis.reference > axis.hi) {
    s.complain(reference_key,
               fmt::format("'{}' lies outside the travel [reference_out_of_range]", reference_key));
  }
  const auto point = s.numbers<3>("sensed_point_mm");
  s.check(check_offset("sensed_point_mm", point), "sensed_point_mm");
  axis.sensed.at_zero = Vec3(point[0], point[1], point[2]);
  axis.sensed.kappa = static_cast<int>(s.integer("kappa", -1, 1));
  return axis;
}

Joint read_joint(const Section& s, const std::vector<AxisFile>& axes) {
  Joint joint;
  const std::string kind = !s.has("joint") ? "fixed" : s.text("joint");
  if (s.has("offset_mm")) {
    joint.offset = s.numbers<3>("offset_mm");
    s.check(check_offset("offset_mm", joint.offset), "offset_mm");
  }
  if (s.has("orientation")) joint.orientation = s.numbers<9>("orientation");
  if (kind == "fixed") return joint;
  joint.kind = s.choice("joint", {"fixed", "linear", "rotary"}) == 1 ? JointKind::prismatic
                                                                     : JointKind::rotary;
  joint.letter = letter_of(s, "axis");
  joint.axis = static_cast<Axis>(
      s.choice(kind == "rotary" ? "turns_about" : "moves_along", {"X", "Y", "Z"}));
  const long sign = s.integer("sign", -1, 1);
  if (sign == 0) s.complain("sign", "'sign' must be 1 or -1");
  joint.sign = static_cast<std::int8_t>(sign);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].letter != joint.letter) continue;
    joint.nc_axis = static_cast<std::uint8_t>(a);
    return joint;
  }
  s.complain("axis", fmt::format("axis {} has no [[axis]] table", joint.letter));
}

std::uint8_t body_number(const MachineFile& file, const Section& s, const std::string& key) {
  const std::string name = s.text(key);
  for (std::size_t k = 0; k < file.body_names.size(); ++k) {
    if (file.body_names[k] == name) return static_cast<std::uint8_t>(k + 1);
  }
  s.complain(key, fmt::format("no earlier [[body]] is called \"{}\"", name));
}

void read_bodies(const Section& top, MachineFile& file, MachineDescription& d) {
  for (const Section& s : top.tables("body")) {
    s.allow_only({"name", "on", "joint", "axis", "moves_along", "turns_about", "sign", "offset_mm",
                  "orientation", "constant_error"});
    if (d.body_count == kMaxBodies)
      s.complain("name", fmt::format("more than {} bodies", kMaxBodies));
    Body& body = d.body.at(d.body_count);
    body.lower = d.body_count == 0 ? std::uint8_t{0} : body_number(file, s, "on");
    body.joint = read_joint(s, file.axes);
    if (s.has("constant_error")) body.constant_error = s.numbers<6>("constant_error");
    file.body_names.push_back(s.text("name"));
    ++d.body_count;
  }
}

void read_correction(const Section& top, MachineFile& file, MachineDescription& d) {
  const Section s = top.table("correction");
  s.allow_only({"axes", "limit_mm", "rate_mm_per_s", "hysteresis_mm", "ramp_s", "tick_hz",
                "max_speed_mm_per_s"});
  const toml::value& axes = s.need("axes");
  if (!axes.is_array() || axes.as_array().empty() || axes.as_array().size() > kMaxCorrecting) {
    s.complain("axes", fmt::format("'axes' must list one to {} correcting axes", kMaxCorrecting));
  }
  for (const toml::value& v : axes.as_array()) {
    if (!v.is_string() || v.as_string().str.size() != 1)
      s.complain("axes", "'axes' must be letters");
    d.correcting.at(d.correcting_count++) =
        static_cast<std::uint8_t>(file.axis_index(v.as_string().str[0]));
  }
  CorrectionFile& c = file.correction;
  c.limit_mm = s.number_or("limit_mm", c.limit_mm);
  c.rate_mm_per_s = s.number_or("rate_mm_per_s", c.rate_mm_per_s);
  c.hysteresis_mm = s.number_or("hysteresis_mm", c.hysteresis_mm);
  c.ramp_s = s.number_or("ramp_s", c.ramp_s);
  c.tick_hz = s.number_or("tick_hz", c.tick_hz);
  c.max_speed_mm_per_s = s.number_or("max_speed_mm_per_s", c.max_speed_mm_per_s);
  const auto range = [&](const char* key, double value, double lo, double hi) {
    if (!(value >= lo && value <= hi))
      s.complain(s.has(key) ? key : "axes", fmt::format("'{}' must be from {} to {}", key, lo, hi));
  };
  range("limit_mm", c.limit_mm, 1e-6, 4.194);
  range("rate_mm_per_s", c.rate_mm_per_s, 1e-3, 1e6);
  range("hysteresis_mm", c.hysteresis_mm, 0.0, 1.0);
  range("ramp_s", c.ramp_s, 1e-4, 60.0);
  range("tick_hz", c.tick_hz, 1.0, 1e5);
  range("max_speed_mm_per_s", c.max_speed_mm_per_s, 0.0, 1e5);
}

SquarenessFile read_squareness(const Section& s) {
  s.allow_only({"a_xy_rad", "a_xz_rad", "a_yz_rad", "at_mm", "x_mm", "y_mm", "z_mm", "points"});
  SquarenessFile q;
  q.points = static_cast<std::size_t>(s.integer_or("points", 7, 2, 101));
  const std::array<std::string, 3> keys{"a_xy_rad", "a_xz_rad", "a_yz_rad"};
  std::array<double, 3> angle{};
  for (std::size_t i = 0; i < 3; ++i) {
    angle[i] = s.number(keys[i]);
    s.check(check_squareness(keys[i].c_str(), {angle[i], 0.0, 0.0}), keys[i]);
  }
  q.measured = {angle[0], angle[1], angle[2]};
  const auto at = s.numbers<3>("at_mm");
  q.at = Vec3(at[0], at[1], at[2]);
  const std::array<std::string, 3> lines{"x_mm", "y_mm", "z_mm"};
  for (std::size_t i = 0; i < 3; ++i) {
    q.segment[i] = s.numbers<2>(lines[i]);
    if (!(q.segment[i][0] < q.segment[i][1]))
      s.complain(lines[i], fmt::format("'{}' must be [low, high]", lines[i]));
  }
  return q;
}

void read_tables(const Section& s, MachineFile& file) {
  s.allow_only({"refine", "interpolation"});
  file.refine = static_cast<std::size_t>(s.integer_or("refine", 8, 1, 64));
  if (s.has("interpolation")) {
    file.interpolation =
        static_cast<Interpolation>(s.choice("interpolation", {"linear", "catmull_rom", "pchip"}));
  }
}

// The TOML library recurses once per bracket and copies freely; no machine file comes near these
// limits.
void refuse_monsters(const std::string& text, const std::string& name) {
  constexpr std::size_t kLargest = 1U << 20U;
  constexpr int kDeepest = 32;
  if (text.size() > kLargest)
    throw UserError(name + ": larger than 1 MiB, this is not a machine file");
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest) throw UserError(name + ": brackets nested too deep");
  }
}

MachineFile read_machine(const toml::value& root, const std::string& name) {
  const Section top(root, name, "the machine file");
  top.allow_only({"name", "id", "convention", "side", "tool", "work", "body", "axis", "correction",
                  "tables", "squareness"});
  MachineFile file;
  file.path = name;
  file.name = top.text("name");
  file.id = static_cast<std::uint32_t>(top.integer("id", 0, 0xFFFFFFFFL));
  file.convention =
      top.choice("convention", {"relative", "body"}) == 0 ? Convention::relative : Convention::body;
  file.side = static_cast<Side>(top.choice("side", {"moving", "fixed", "base"}));
  for (const Section& s : top.tables("axis")) {
    if (file.axes.size() == kMaxAxes)
      s.complain("name", fmt::format("more than {} axes", kMaxAxes));
    file.axes.push_back(read_axis(s));
  }

  MachineDescription d;
  read_bodies(top, file, d);
  const Section tool = top.table("tool");
  tool.allow_only({"body", "point_mm"});
  d.tool_body = body_number(file, tool, "body");
  d.tool_point = tool.numbers<3>("point_mm");
  tool.check(check_offset("point_mm", d.tool_point), "point_mm");
  const Section work = top.table("work");
  work.allow_only({"body"});
  d.work_body = body_number(file, work, "body");
  read_correction(top, file, d);
  require(MachineChain::build(d, file.chain), name);
  if (file.chain.axis_count() != file.axes.size()) {
    top.complain("axis", "every [[axis]] needs exactly one [[body]] that it moves");
  }
  if (top.has("tables")) read_tables(top.table("tables"), file);
  if (top.has("squareness")) file.squareness = read_squareness(top.table("squareness"));
  return file;
}

}  // namespace

std::vector<double> SquarenessFile::line(std::size_t axis) const {
  std::vector<double> positions;
  for (std::size_t i = 0; i < points; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(points - 1);
    positions.push_back(segment.at(axis)[0] + s * (segment.at(axis)[1] - segment.at(axis)[0]));
  }
  return positions;
}

std::size_t MachineFile::axis_index(char letter) const {
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].letter == letter) return a;
  }
  throw UserError(fmt::format("{}: there is no axis {}", path, letter));
}

MachineFile parse_machine(const std::string& text, const std::string& name) {
  refuse_monsters(text, name);
  try {
    std::istringstream stream(text);
    return read_machine(toml::parse(stream, name), name);
  } catch (const toml::exception& e) {
    throw UserError(fmt::format("{}:{}: not valid TOML", name, e.location().line()));
  } catch (const std::exception& e) {
    if (dynamic_cast<const UserError*>(&e) != nullptr) throw;
    throw UserError(fmt::format("{}: not valid TOML ({})", name, e.what()));
  }
}

MachineFile read_machine_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path))
    throw UserError(fmt::format("{}: cannot be opened", path.string()));
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_machine(text.str(), path.string());
}

std::filesystem::path bundled_machine(const std::string& name) {
  const char* const folder = std::getenv("VOLCOMP_MACHINES");
  std::filesystem::path path =
      std::filesystem::path(folder != nullptr ? folder : VOLCOMP_MACHINES_DIR) / (name + ".toml");
  if (!std::filesystem::exists(path)) {
    throw UserError(fmt::format(
        "{}: no such machine file (set VOLCOMP_MACHINES or give --machine FILE)", path.string()));
  }
  return path;
}

}  // namespace volcomp::sim
