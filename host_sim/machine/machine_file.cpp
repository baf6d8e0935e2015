#include "host_sim/machine/machine_file.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include "comp/geometry/frame.hpp"
#include "comp/tables/plausibility.hpp"
#include "comp/units.hpp"
#include "host_sim/data/toml_text.hpp"
#include "host_sim/data/user_error.hpp"
#include "host_sim/machine/machine_sections.hpp"

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
                "sensed_point_mm", "kappa", "latch_delay_us"});
  AxisFile axis;
  axis.letter = letter_of(s, "name");
  axis.rotary = s.has("travel_rad");
  const std::string travel_key = axis.rotary ? "travel_rad" : "travel_mm";
  const auto travel = s.numbers<2>(travel_key);
  axis.lo = travel[0];
  axis.hi = travel[1];
  if (!(axis.lo < axis.hi))
    s.complain(travel_key, fmt::format("'{}' must be [low, high]", travel_key));
  axis.targets =
      static_cast<std::size_t>(s.integer_or("targets", 11, 2, static_cast<long>(kTableKnots)));
  const std::string reference_key = axis.rotary ? "reference_rad" : "reference_mm";
  axis.reference = s.number(reference_key);
  if (axis.reference < axis.lo || axis.reference > axis.hi) {
    s.complain(reference_key,
               fmt::format("'{}' lies outside the travel [reference_out_of_range]", reference_key));
  }
  const auto point = s.numbers<3>("sensed_point_mm");
  s.check(check_offset("sensed_point_mm", point), "sensed_point_mm");
  axis.sensed.at_zero = Vec3(point[0], point[1], point[2]);
  axis.sensed.kappa = static_cast<int>(s.integer("kappa", -1, 1));
  axis.latch_delay_us = read_delay_us(s, "latch_delay_us");
  return axis;
}

// The reading of a rotary axis at which its frame stands like that of the body before it.
void turn_to_zero(const Section& s, Joint& joint) {
  if (joint.kind != JointKind::rotary || s.has("orientation"))
    s.complain("zero_deg", "'zero_deg' is for rotary joints without 'orientation'");
  const double zero = s.number("zero_deg") * kPi / 180.0;
  const Mat3 back = axis_rotation(joint.axis, -joint.sign * zero);
  for (std::size_t i = 0; i < 9; ++i)
    joint.orientation.at(i) =
        back(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3));
}

Joint read_joint(const Section& s, const std::vector<AxisFile>& axes) {
  Joint joint;
  const std::string kind = !s.has("joint") ? "fixed" : s.text("joint");
  if (s.has("offset_mm")) {
    joint.offset = s.numbers<3>("offset_mm");
    s.check(check_offset("offset_mm", joint.offset), "offset_mm");
  }
  if (s.has("orientation")) joint.orientation = s.numbers<9>("orientation");
  if (kind == "fixed") {
    if (s.has("zero_deg")) turn_to_zero(s, joint);
    return joint;
  }
  joint.kind = s.choice("joint", {"fixed", "linear", "rotary"}) == 1 ? JointKind::prismatic
                                                                     : JointKind::rotary;
  joint.letter = letter_of(s, "axis");
  joint.axis = static_cast<Axis>(
      s.choice(kind == "rotary" ? "turns_about" : "moves_along", {"X", "Y", "Z"}));
  const long sign = s.integer("sign", -1, 1);
  if (sign == 0) s.complain("sign", "'sign' must be 1 or -1");
  joint.sign = static_cast<std::int8_t>(sign);
  if (s.has("zero_deg")) turn_to_zero(s, joint);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].letter != joint.letter) continue;
    if (axes[a].rotary != (joint.kind == JointKind::rotary))
      s.complain("joint",
                 fmt::format("axis {} is {} here, but its [[axis]] table says '{}'", joint.letter,
                             kind, axes[a].rotary ? "travel_rad" : "travel_mm"));
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
                  "orientation", "zero_deg", "constant_error"});
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
  s.allow_only({"axes", "limit_mm", "rate_mm_per_s", "hysteresis_mm", "max_speed_mm_per_s",
                "limit_rad", "rate_rad_per_s", "hysteresis_rad", "max_speed_rad_per_s", "ramp_s",
                "tick_hz"});
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
  read_correction_values(s, file.correction);
}

void read_tables(const Section& s, MachineFile& file) {
  s.allow_only({"refine", "interpolation"});
  file.refine = static_cast<std::size_t>(s.integer_or("refine", 8, 1, 64));
  if (s.has("interpolation")) {
    file.interpolation =
        static_cast<Interpolation>(s.choice("interpolation", {"linear", "catmull_rom", "pchip"}));
  }
}

MachineFile read_machine(const toml::value& root, const std::string& name) {
  const Section top(root, name, "the machine file");
  top.allow_only({"name", "id", "convention", "side", "tool", "work", "body", "axis", "correction",
                  "tables", "squareness", "probe", "gear", "wheel", "stroke"});
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
  if (top.has("probe")) file.probe = read_probe(top.table("probe"));
  if (top.has("gear") || top.has("wheel") || top.has("stroke")) file.grinding = read_grinding(top);
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

void MachineFile::expect_axes(const std::string& letters) const {
  std::string found;
  for (const AxisFile& axis : axes)
    found += axis.letter;
  if (found == letters) return;
  throw UserError(fmt::format("{}: the axes must be {}, not {}", path, fmt::join(letters, " "),
                              fmt::join(found, " ")));
}

std::size_t MachineFile::axis_index(char letter) const {
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].letter == letter) return a;
  }
  throw UserError(fmt::format("{}: there is no axis {}", path, letter));
}

MachineFile parse_machine(const std::string& text, const std::string& name) {
  return read_toml(text, name, [&](const toml::value& root) { return read_machine(root, name); });
}

MachineFile read_machine_file(const std::filesystem::path& path) {
  return parse_machine(text_of_file(path), path.string());
}

namespace {

// An installed program has them beside it, one that was just built in its source folder.
std::filesystem::path machines_folder() {
  if (const char* const folder = std::getenv("VOLCOMP_MACHINES"); folder != nullptr) return folder;
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  auto installed = self.parent_path().parent_path() / "share/volcomp/machines";
  return std::filesystem::exists(installed, error) ? installed : VOLCOMP_MACHINES_DIR;
}

}  // namespace

std::filesystem::path bundled_machine(const std::string& name) {
  std::filesystem::path path = machines_folder() / (name + ".toml");
  if (!std::filesystem::exists(path)) {
    throw UserError(fmt::format(
        "{}: no such machine file (set VOLCOMP_MACHINES or give --machine FILE)", path.string()));
  }
  return path;
}

}  // namespace volcomp::sim
