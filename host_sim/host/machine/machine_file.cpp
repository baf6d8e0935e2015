#include "host_sim/host/machine/machine_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/plausibility.hpp"
#include "host_sim/host/io/bundled_files.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/machine_bodies.hpp"
#include "host_sim/host/machine/machine_bus.hpp"
#include "host_sim/host/machine/machine_sections.hpp"

namespace volcomp::host {
namespace {

using Section = TomlSection;

void allow_fields(const Section& s, bool in_chain) {
  std::vector<std::string> fields{
      "name",          "travel_mm",       "travel_rad", "targets",        "reference_mm",
      "reference_rad", "sensed_point_mm", "kappa",      "latch_delay_us", "error_at_reference"};
  fields.insert(fields.end(), axis_acceleration_fields().begin(), axis_acceleration_fields().end());
  fields.insert(fields.end(), drive_fields().begin(), drive_fields().end());
  if (in_chain) fields.insert(fields.end(), joint_fields().begin(), joint_fields().end());
  s.allow_only(fields);
}

// A turn as people write it, 6.2832, is a turn.
void read_travel(const Section& s, AxisFile& axis) {
  constexpr double kAsWritten_rad = 1e-4;
  axis.rotary = s.has("travel_rad");
  const std::string key = axis.rotary ? "travel_rad" : "travel_mm";
  const auto travel = s.numbers<2>(key);
  axis.lo = travel[0];
  axis.hi = travel[1];
  if (!(axis.lo < axis.hi)) s.complain(key, fmt::format("'{}' must be [low, high]", key));
  if (!axis.rotary) return;
  if (std::abs(axis.hi - axis.lo - 2.0 * kPi) < kAsWritten_rad) axis.hi = axis.lo + 2.0 * kPi;
  if (axis.hi - axis.lo > 2.0 * kPi && !axis.full_turn())
    s.complain(key,
               fmt::format("'{}' is more than one turn [{}]", key, code(Reason::travel_too_long)));
}

AxisFile read_axis(const Section& s, std::size_t number, bool in_chain) {
  allow_fields(s, in_chain);
  AxisFile axis;
  axis.letter = letter_of(s, "name");
  read_travel(s, axis);
  axis.targets =
      static_cast<std::size_t>(s.integer_or("targets", 11, 2, static_cast<long>(kTableKnots)));
  const std::string reference_key = axis.rotary ? "reference_rad" : "reference_mm";
  axis.reference = s.number(reference_key);
  if (axis.reference < axis.lo || axis.reference > axis.hi) {
    s.complain(reference_key, fmt::format("'{}' lies outside the travel [{}]", reference_key,
                                          code(Reason::reference_out_of_range)));
  }
  const auto point = s.numbers<3>("sensed_point_mm");
  s.check(check_offset("sensed_point_mm", point), "sensed_point_mm");
  axis.sensed.at_zero = Vec3(point[0], point[1], point[2]);
  axis.sensed.kappa = static_cast<int>(s.integer("kappa", -1, 1));
  axis.latch_delay_us = read_delay_us(s, "latch_delay_us");
  read_axis_acceleration(s, axis);
  axis.drive = read_drive(s, axis, number);
  if (s.has("error_at_reference")) axis.at_reference = read_error(s, "error_at_reference");
  return axis;
}

// Letters of up to `most` axes.
std::vector<std::uint8_t> read_letters(const Section& s, const char* key, std::size_t most,
                                       const char* what, const MachineFile& file) {
  const TomlValue& letters = s.need(key);
  if (!letters.is_array() || letters.array().empty() || letters.array().size() > most)
    s.complain(key, fmt::format("'{}' must list one to {} {} axes", key, most, what));
  std::vector<std::uint8_t> axes;
  for (const TomlValue& v : letters.array()) {
    if (!v.is_text() || v.text().size() != 1)
      s.complain(key, fmt::format("'{}' must be letters", key));
    axes.push_back(static_cast<std::uint8_t>(file.axis_index(v.text()[0])));
  }
  return axes;
}

// Reads the orienting axes, none of which may be a correcting one.
std::vector<std::uint8_t> read_orienting(const Section& s, const MachineFile& file,
                                         const std::vector<std::uint8_t>& correcting) {
  if (!s.has("orienting")) return {};
  auto axes = read_letters(s, "orienting", kMaxOrienting, "orienting", file);
  std::set<std::uint8_t> taken(correcting.begin(), correcting.end());
  for (const std::uint8_t a : axes) {
    const AxisFile& axis = file.axes[a];
    if (!axis.rotary)
      s.complain("orienting", fmt::format("{} does not turn: it cannot orient the tool [{}]",
                                          axis.letter, code(Reason::cannot_orient)));
    if (!taken.insert(a).second)
      s.complain("orienting", fmt::format("{} takes another offset already", axis.letter));
  }
  return axes;
}

void read_correction(const Section& top, MachineFile& file, MachineDescription& d) {
  const Section s = top.table("correction");
  s.allow_only({"axes", "orienting", "limit_mm", "rate_mm_per_s", "hysteresis_mm",
                "max_speed_mm_per_s", "limit_rad", "rate_rad_per_s", "hysteresis_rad",
                "max_speed_rad_per_s", "ramp_s", "tick_hz", "acceleration_mm_per_s2",
                "acceleration_rad_per_s2"});
  const auto correcting = read_letters(s, "axes", kMaxCorrecting, "correcting", file);
  for (const std::uint8_t axis : correcting)
    d.correcting.at(d.correcting_count++) = axis;
  for (const std::uint8_t axis : read_orienting(s, file, correcting))
    d.orienting.at(d.orienting_count++) = axis;
  read_correction_values(s, file.correction);
  read_offset_acceleration(s, axes_with_offsets(d), file);
}

void read_tables(const Section& s, MachineFile& file) {
  s.allow_only({"refine", "interpolation"});
  file.refine = static_cast<std::size_t>(s.integer_or("refine", 8, 1, 64));
  if (s.has("interpolation")) {
    file.interpolation =
        static_cast<Interpolation>(s.choice("interpolation", {"linear", "catmull_rom", "pchip"}));
  }
}

// A ball bar cannot have gone where the axes do not go.
void require_circles_in_travel(const MachineFile& file, const Section& s) {
  if (!file.squareness->circle_radius) return;
  for (const AxisFile& axis : file.axes) {
    if (axis.rotary || axis.letter < 'X' || axis.letter > 'Z') continue;
    const double at = file.squareness->at(axis.letter - 'X');
    const double radius = *file.squareness->circle_radius;
    if (at - radius >= axis.lo && at + radius <= axis.hi) continue;
    s.complain("circle_radius_mm",
               fmt::format("the circle leaves the travel of {}: {:g} ± {:g} mm in {:g} … {:g}",
                           axis.letter, at, radius, axis.lo, axis.hi));
  }
}

void expect_new_letter(const Section& s, const MachineFile& file) {
  const char letter = file.axes.back().letter;
  if (file.axis_index(letter) + 1 < file.axes.size())
    s.complain("name", fmt::format("there are two axes {}", letter));
}

MachineFile read_machine(const TomlValue& root, const std::string& name) {
  const Section top(root, name, "the machine file");
  top.allow_only({"name", "id", "convention", "side", "chain", "tool", "work", "body", "axis",
                  "correction", "tables", "squareness", "thermal", "probe", "laser", "gear",
                  "wheel", "stroke", "bus"});
  MachineFile file;
  file.path = name;
  file.name = top.text("name");
  file.id = static_cast<std::uint32_t>(top.integer("id", 1, 0xFFFFFFFFL));
  file.convention =
      top.choice("convention", {"relative", "body"}) == 0 ? Convention::relative : Convention::body;
  file.side = static_cast<Side>(top.choice("side", {"moving", "fixed", "base"}));
  for (const Section& s : top.tables("axis")) {
    if (file.axes.size() == kMaxAxes)
      s.complain("name", fmt::format("more than {} axes", kMaxAxes));
    file.axes.push_back(read_axis(s, file.axes.size(), top.has("chain") || !top.has("body")));
    expect_new_letter(s, file);
  }

  MachineDescription d;
  read_bodies(top, file, d);
  const Section tool = top.table("tool");
  if (top.has("chain")) {
    tool.allow_only({"point_mm"});
  } else {
    tool.allow_only({"body", "point_mm"});
  }
  d.tool_point = tool.numbers<3>("point_mm");
  tool.check(check_offset("point_mm", d.tool_point), "point_mm");
  read_correction(top, file, d);
  require(MachineChain::build(d, file.chain), name);
  if (file.chain.axis_count() != file.axes.size())
    top.complain("axis", "every [[axis]] needs exactly one [[body]] that it moves");
  read_bus(top, file);
  if (top.has("tables")) read_tables(top.table("tables"), file);
  if (top.has("thermal")) file.thermal = read_thermal(top.table("thermal"), file);
  if (top.has("probe")) file.probe = read_probe(top.table("probe"));
  if (top.has("laser")) file.laser = read_laser(top.table("laser"));
  if (top.has("gear") || top.has("wheel") || top.has("stroke")) file.grinding = read_grinding(top);
  if (top.has("squareness")) {
    file.squareness = read_squareness(top.table("squareness"));
    require_circles_in_travel(file, top.table("squareness"));
  }
  return file;
}

}  // namespace

std::vector<std::size_t> axes_with_offsets(const MachineDescription& d) {
  std::vector<std::size_t> axes(d.correcting.begin(), d.correcting.begin() + d.correcting_count);
  axes.insert(axes.end(), d.orienting.begin(), d.orienting.begin() + d.orienting_count);
  return axes;
}

CorrectionFile CorrectionFile::with_default_acceleration() const {
  CorrectionFile limited = *this;
  for (OffsetAcceleration& a : limited.acceleration)
    a.stated = true;
  return limited;
}

bool AxisFile::full_turn() const { return rotary && std::abs(hi - lo - 2.0 * kPi) < 1e-9; }

double AxisFile::target(std::size_t t) const {
  return lo + static_cast<double>(t) * (hi - lo) / static_cast<double>(targets - 1);
}

std::vector<double> AxisFile::all_targets() const {
  std::vector<double> all;
  for (std::size_t t = 0; t < targets; ++t)
    all.push_back(target(t));
  return all;
}

std::size_t AxisFile::reference_target() const {
  const double part = (reference - lo) / (hi - lo);
  return static_cast<std::size_t>(std::lround(part * static_cast<double>(targets - 1)));
}

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
  return read_toml(text, name, [&](const TomlValue& root) { return read_machine(root, name); });
}

MachineFile read_machine_file(const std::filesystem::path& path) {
  return parse_machine(text_of_file(path), shown_name(path));
}

namespace {

constexpr BundledFiles kMachines{"machines", ".toml", "VOLCOMP_MACHINES"};

}  // namespace

std::vector<std::string> bundled_machines() { return names_of(kMachines); }

std::filesystem::path bundled_machine(const std::string& name) {
  std::filesystem::path path = path_of(kMachines, name);
  if (!std::filesystem::exists(path)) {
    throw UserError(fmt::format(
        "{}: no such machine file (set VOLCOMP_MACHINES or give --machine FILE)", path.string()));
  }
  return path;
}

}  // namespace volcomp::host
