#include "host_sim/machine/machine_file.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <toml.hpp>

#include "comp/tables/plausibility.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

using Value = toml::value;

[[noreturn]] void fail(const Value& at, const std::string& file, const std::string& text) {
  throw UserError(fmt::format("{}:{}: {}", file, at.location().line(), text));
}

// One table of the file; remembers where it is, so that every complaint can say so.
class Section {
 public:
  Section(const Value& value, std::string file, std::string name)
      : value_(value), file_(std::move(file)), name_(std::move(name)) {
    if (!value_.is_table()) fail(value_, file_, fmt::format("'{}' must be a table", name_));
  }

  [[nodiscard]] const Value* find(const std::string& key) const {
    const auto& table = value_.as_table();
    const auto it = table.find(key);
    return it == table.end() ? nullptr : &it->second;
  }

  [[nodiscard]] const Value& need(const std::string& key) const {
    const Value* v = find(key);
    if (v == nullptr) {
      fail(value_, file_,
           fmt::format("missing mandatory field '{}' in {} [missing_field]", key, name_));
    }
    return *v;
  }

  [[nodiscard]] double number(const Value& v, const std::string& key) const {
    const double x = v.is_floating()  ? v.as_floating()
                     : v.is_integer() ? static_cast<double>(v.as_integer())
                                      : std::nan("");
    if (!std::isfinite(x)) fail(v, file_, fmt::format("'{}' must be a finite number", key));
    return x;
  }
  [[nodiscard]] double number(const std::string& key) const { return number(need(key), key); }
  [[nodiscard]] double number_or(const std::string& key, double fallback) const {
    return find(key) == nullptr ? fallback : number(key);
  }

  [[nodiscard]] long integer(const std::string& key, long lo, long hi) const {
    const Value& v = need(key);
    if (!v.is_integer() || v.as_integer() < lo || v.as_integer() > hi) {
      fail(v, file_, fmt::format("'{}' must be a whole number from {} to {}", key, lo, hi));
    }
    return static_cast<long>(v.as_integer());
  }
  [[nodiscard]] long integer_or(const std::string& key, long fallback, long lo, long hi) const {
    return find(key) == nullptr ? fallback : integer(key, lo, hi);
  }

  [[nodiscard]] std::string text(const std::string& key) const {
    const Value& v = need(key);
    if (!v.is_string() || v.as_string().str.empty())
      fail(v, file_, fmt::format("'{}' must be a text", key));
    return v.as_string().str;
  }

  template <std::size_t N>
  [[nodiscard]] std::array<double, N> numbers(const std::string& key) const {
    const Value& v = need(key);
    if (!v.is_array() || v.as_array().size() != N) {
      fail(v, file_, fmt::format("'{}' must be a list of {} numbers", key, N));
    }
    std::array<double, N> out{};
    for (std::size_t i = 0; i < N; ++i)
      out[i] = number(v.as_array()[i], key);
    return out;
  }

  // One of the given words, by position.
  [[nodiscard]] std::size_t choice(const std::string& key,
                                   const std::vector<std::string>& words) const {
    const std::string word = text(key);
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] == word) return i;
    }
    fail(need(key), file_,
         fmt::format("'{}' is \"{}\", must be one of: {}", key, word, fmt::join(words, ", ")));
  }

  void allow_only(const std::vector<std::string>& keys) const {
    for (const auto& [key, v] : value_.as_table()) {
      bool known = false;
      for (const std::string& k : keys)
        known = known || k == key;
      if (!known)
        fail(
            v, file_,
            fmt::format("unknown field '{}' in {} (known: {})", key, name_, fmt::join(keys, ", ")));
    }
  }

  // Refusals of the library, at the line of a field.
  void check(const Status& status, const std::string& key) const {
    if (!status.ok()) fail(need(key), file_, describe(status));
  }

  [[nodiscard]] Section table(const std::string& key) const {
    return {need(key), file_, "[" + key + "]"};
  }
  [[nodiscard]] std::vector<Section> tables(const std::string& key) const {
    const Value& list = need(key);
    if (!list.is_array() || list.as_array().empty())
      fail(list, file_, fmt::format("'{}' must be a list of tables", key));
    std::vector<Section> sections;
    for (const Value& v : list.as_array())
      sections.emplace_back(v, file_, "[[" + key + "]]");
    return sections;
  }
  [[noreturn]] void complain(const std::string& key, const std::string& text) const {
    fail(need(key), file_, text);
  }

 private:
  const Value& value_;
  std::string file_;
  std::string name_;
};

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
  const bool rotary = s.find("travel_rad") != nullptr;
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
  const std::string kind = s.find("joint") == nullptr ? "fixed" : s.text("joint");
  if (s.find("offset_mm") != nullptr) {
    joint.offset = s.numbers<3>("offset_mm");
    s.check(check_offset("offset_mm", joint.offset), "offset_mm");
  }
  if (s.find("orientation") != nullptr) joint.orientation = s.numbers<9>("orientation");
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
    if (s.find("constant_error") != nullptr) body.constant_error = s.numbers<6>("constant_error");
    file.body_names.push_back(s.text("name"));
    ++d.body_count;
  }
}

void read_correction(const Section& top, MachineFile& file, MachineDescription& d) {
  const Section s = top.table("correction");
  s.allow_only({"axes", "limit_mm", "rate_mm_per_s", "hysteresis_mm", "ramp_s", "tick_hz",
                "max_speed_mm_per_s"});
  const Value& axes = s.need("axes");
  if (!axes.is_array() || axes.as_array().empty() || axes.as_array().size() > kMaxCorrecting) {
    s.complain("axes", fmt::format("'axes' must list one to {} correcting axes", kMaxCorrecting));
  }
  for (const Value& v : axes.as_array()) {
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
      s.complain(s.find(key) != nullptr ? key : "axes",
                 fmt::format("'{}' must be from {} to {}", key, lo, hi));
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
  if (s.find("interpolation") != nullptr) {
    file.interpolation =
        static_cast<Interpolation>(s.choice("interpolation", {"linear", "catmull_rom", "pchip"}));
  }
}

MachineFile read_machine(const Value& root, const std::string& name) {
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
  if (top.find("tables") != nullptr) read_tables(top.table("tables"), file);
  if (top.find("squareness") != nullptr) file.squareness = read_squareness(top.table("squareness"));
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
  const std::filesystem::path path =
      std::filesystem::path(folder != nullptr ? folder : VOLCOMP_MACHINES_DIR) / (name + ".toml");
  if (!std::filesystem::exists(path)) {
    throw UserError(fmt::format(
        "{}: no such machine file (set VOLCOMP_MACHINES or give --machine FILE)", path.string()));
  }
  return path;
}

}  // namespace volcomp::sim
