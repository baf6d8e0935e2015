#include "host_sim/host/machine/machine_bodies.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/machine/frame.hpp"
#include "comp/metrology/tables/plausibility.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/machine/machine_sections.hpp"

namespace volcomp::host {
namespace {

using Section = TomlSection;

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

void read_offset(const Section& s, Joint& joint) {
  if (s.has("offset_mm")) {
    joint.offset = s.numbers<3>("offset_mm");
    s.check(check_offset("offset_mm", joint.offset), "offset_mm");
  }
  if (s.has("orientation")) joint.orientation = s.numbers<9>("orientation");
  if (s.has("zero_deg")) turn_to_zero(s, joint);
}

std::int8_t read_sign(const Section& s) {
  const long sign = s.integer("sign", -1, 1);
  if (sign == 0) s.complain("sign", "'sign' must be 1 or -1");
  return static_cast<std::int8_t>(sign);
}

// --- a list of bodies

void expect_kind(const Section& s, const AxisFile& axis, const std::string& kind) {
  if (axis.rotary == (kind == "rotary")) return;
  s.complain("joint", fmt::format("axis {} is {} here, but its [[axis]] table says '{}'",
                                  axis.letter, kind, axis.rotary ? "travel_rad" : "travel_mm"));
}

Joint read_joint(const Section& s, const std::vector<AxisFile>& axes) {
  Joint joint;
  const std::string kind = !s.has("joint") ? "fixed" : s.text("joint");
  if (kind == "fixed") {
    read_offset(s, joint);
    return joint;
  }
  joint.kind = s.choice("joint", {"fixed", "linear", "rotary"}) == 1 ? JointKind::prismatic
                                                                     : JointKind::rotary;
  joint.letter = letter_of(s, "axis");
  joint.axis = static_cast<Axis>(
      s.choice(kind == "rotary" ? "turns_about" : "moves_along", {"X", "Y", "Z"}));
  joint.sign = read_sign(s);
  read_offset(s, joint);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].letter != joint.letter) continue;
    expect_kind(s, axes[a], kind);
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

void read_constant_error(const Section& s, Body& body) {
  if (body.joint.moves()) {
    s.complain("constant_error",
               "'constant_error' is of bodies that do not move; of an axis it is "
               "'error_at_reference'");
  }
  const ErrorMotion error = read_error(s, "constant_error");
  std::copy(error.begin(), error.end(), body.constant_error.begin());
}

void read_list(const Section& top, MachineFile& file, MachineDescription& d) {
  for (const Section& s : top.tables("body")) {
    s.allow_only({"name", "on", "joint", "axis", "moves_along", "turns_about", "sign", "offset_mm",
                  "orientation", "zero_deg", "constant_error"});
    if (d.body_count == kMaxBodies)
      s.complain("name", fmt::format("more than {} bodies", kMaxBodies));
    Body& body = d.body.at(d.body_count);
    if (d.body_count == 0 && s.has("on"))
      s.complain("on", "the first [[body]] is the bed, it hangs on nothing");
    body.lower = d.body_count == 0 ? std::uint8_t{0} : body_number(file, s, "on");
    body.joint = read_joint(s, file.axes);
    if (s.has("constant_error")) read_constant_error(s, body);
    file.body_names.push_back(s.text("name"));
    ++d.body_count;
  }
  d.tool_body = body_number(file, top.table("tool"), "body");
  const Section work = top.table("work");
  work.allow_only({"body"});
  d.work_body = body_number(file, work, "body");
}

// --- a chain

// An axis that carries the workpiece counts the tool against it (ISO 841). Builders of rotary
// tables do so or count the table itself, so the file must state which.
std::int8_t sign_in_chain(const Section& s, const AxisFile& axis, bool work) {
  if (s.has("sign")) return read_sign(s);
  if (!work) return 1;
  if (!axis.rotary) return -1;
  s.complain("name",
             fmt::format("missing mandatory field 'sign' of axis {}, which turns the workpiece: 1 "
                         "if it counts the turning of the table (right-handed), -1 if that of the "
                         "tool against it (ISO 841) [{}]",
                         axis.letter, code(Reason::missing_field)));
}

Joint joint_in_chain(const Section& s, const AxisFile& axis, std::size_t nc_axis, bool work) {
  if (axis.rotary != is_rotary_letter(axis.letter)) {
    s.complain("name", fmt::format("in a chain {} is {}: its [[axis]] needs '{}'", axis.letter,
                                   axis.rotary ? "linear" : "rotary",
                                   axis.rotary ? "travel_mm" : "travel_rad"));
  }
  Joint joint;
  joint.kind = axis.rotary ? JointKind::rotary : JointKind::prismatic;
  joint.letter = axis.letter;
  joint.axis = axis_of_letter(axis.letter);
  joint.nc_axis = static_cast<std::uint8_t>(nc_axis);
  joint.sign = sign_in_chain(s, axis, work);
  read_offset(s, joint);
  return joint;
}

// The bodies beyond the bed, outwards; returns the number of the last.
std::uint8_t append_branch(const Section& top, const std::string& letters, bool work,
                           MachineFile& file, MachineDescription& d) {
  const std::vector<Section> sections = top.tables("axis");
  std::uint8_t last = 1;
  for (const char letter : letters) {
    std::size_t a = 0;
    while (a < file.axes.size() && file.axes[a].letter != letter)
      ++a;
    if (a == file.axes.size())
      top.complain("chain", fmt::format("axis {} of 'chain' has no [[axis]] table", letter));
    Body& body = d.body.at(d.body_count++);
    body.lower = last;
    body.joint = joint_in_chain(sections[a], file.axes[a], a, work);
    file.body_names.emplace_back(1, letter);
    last = d.body_count;
  }
  return last;
}

void read_chain(const Section& top, MachineFile& file, MachineDescription& d) {
  for (const char* const key : {"body", "work"}) {
    if (top.has(key))
      top.complain(key,
                   fmt::format("'chain' and [{}] cannot be used together: the chain says it", key));
  }
  const std::string text = top.text("chain");
  ChainLetters letters;
  const std::string wrong = parse_chain(text, letters);
  if (!wrong.empty())
    top.complain("chain",
                 fmt::format(R"('chain' is "{}": {} (for instance "w-X-Y-b-Z-t"))", text, wrong));
  for (const AxisFile& axis : file.axes) {
    if ((letters.work + letters.tool).find(axis.letter) == std::string::npos)
      top.complain("chain", fmt::format(R"('chain' is "{}": axis {} has no place in it)", text,
                                        axis.letter));
  }
  file.body_names.emplace_back("bed");
  d.body_count = 1;
  d.work_body = append_branch(top, letters.work, true, file, d);
  d.tool_body = append_branch(top, letters.tool, false, file, d);
}

}  // namespace

const std::vector<std::string>& joint_fields() {
  static const std::vector<std::string> kFields{"offset_mm", "sign", "zero_deg", "orientation"};
  return kFields;
}

char letter_of(const Section& section, const std::string& key) {
  const std::string name = section.text(key);
  if (name.size() != 1 || std::string("XYZABCUVW").find(name[0]) == std::string::npos) {
    section.complain(key, fmt::format("'{}' must be one of X Y Z A B C U V W", key));
  }
  return name[0];
}

void read_bodies(const Section& top, MachineFile& file, MachineDescription& d) {
  if (top.has("chain")) return read_chain(top, file, d);
  if (!top.has("body"))
    top.complain("body",
                 fmt::format("missing mandatory field 'chain' (or a list [[body]]) in the machine "
                             "file [{}]",
                             code(Reason::missing_field)));
  read_list(top, file, d);
}

}  // namespace volcomp::host
