#include "host_sim/experiments/l300g/machine_errors.hpp"

#include <algorithm>
#include <map>

#include "comp/core/units.hpp"
#include "host_sim/host/io/toml_text.hpp"

namespace volcomp::l300g {
namespace {

constexpr double kUm = 1e-3;
constexpr double kUrad = 1e-6;
constexpr double kDegree = kPi / 180.0;
constexpr std::array<const char*, kGrinderAxes> kLetters{"X", "Y", "B", "A"};

// Constants of 4 µm and 0.004°, signs by axis in the order EX EY EZ EA EB EC (`p8` in
// docs/papers/l300g.md, "Options").
GrinderErrors p8() {
  constexpr std::array<std::array<int, 6>, kGrinderAxes> kSign{
      {{1, -1, 1, -1, 1, 1}, {1, -1, -1, 1, 1, 1}, {1, -1, 1, 1, -1, 1}, {1, 1, 1, 1, 0, 0}}};
  GrinderErrors errors;
  for (std::size_t a = 0; a < kGrinderAxes; ++a) {
    for (std::size_t c = 0; c < 6; ++c)
      errors.axis[a].constant[c] = kSign[a][c] * (c < 3 ? 4.0 * kUm : 0.004 * kDegree);
  }
  return errors;
}

// The waves of `p8-variation`.
GrinderErrors p8_with_variation() {
  constexpr std::array<double, kGrinderAxes> kPeriod{90.0, 60.0, 10.0 * kDegree, 40.0 * kDegree};
  GrinderErrors errors = p8();
  for (std::size_t a = 0; a < kGrinderAxes; ++a) {
    errors.axis[a].wave_mm = 0.4 * kUm;
    errors.axis[a].wave_rad = 7.0 * kUrad;
    errors.axis[a].wave_period = kPeriod[a];
  }
  return errors;
}

// Means of the readings in the paper's Table 2: of each axis along or about itself.
GrinderErrors table_2() {
  GrinderErrors errors;
  errors.axis[0].constant[0] = 3.80 * kUm;
  errors.axis[1].constant[1] = 4.50 * kUm;
  errors.axis[2].constant[4] = 3.65e-3 * kDegree;
  errors.axis[3].constant[3] = 4.15e-3 * kDegree;
  return errors;
}

GrinderErrors short_arm() {
  GrinderErrors errors;
  errors.arm_mm = -0.17;
  return errors;
}

GrinderErrors a_slope() {
  GrinderErrors errors;
  errors.axis[3].slope[3] = 8.6e-4;
  return errors;
}

// --- files

// Six numbers of µm and µrad, or zeros.
std::array<double, 6> six(const host::TomlSection& s, const std::string& key) {
  std::array<double, 6> values{};
  if (!s.has(key)) return values;
  values = s.numbers<6>(key);
  for (std::size_t c = 0; c < 6; ++c)
    values[c] *= c < 3 ? kUm : kUrad;
  return values;
}

AxisErrors read_axis(const host::TomlSection& s, double sign) {
  s.allow_only({"constant", "slope", "wave_um", "wave_urad", "wave_period_mm", "wave_period_deg"});
  AxisErrors axis;
  axis.constant = six(s, "constant");
  axis.slope = six(s, "slope");
  for (std::size_t c = 0; c < 6; ++c) {
    axis.constant[c] *= sign;
    axis.slope[c] *= sign;
  }
  axis.wave_mm = s.number_or("wave_um", 0.0) * kUm;
  axis.wave_rad = s.number_or("wave_urad", 0.0) * kUrad;
  axis.wave_period = s.number_or("wave_period_mm", s.number_or("wave_period_deg", 0.0) * kDegree);
  if (axis.waves() && !(axis.wave_period > 0.0))
    s.complain("wave_um", "a wave needs 'wave_period_mm' or 'wave_period_deg' above 0");
  return axis;
}

GrinderErrors read_errors(const host::TomlSection& top) {
  top.allow_only({"convention", "arm_mm", "X", "Y", "B", "A"});
  const bool relative = top.choice("convention", {"relative", "body"}) == 0;
  GrinderErrors errors;
  errors.arm_mm = top.number_or("arm_mm", 0.0);
  for (std::size_t a = 0; a < kGrinderAxes; ++a) {
    if (!top.has(kLetters[a])) continue;
    // A carries the work: its motion relative to the work is the tool's, reversed.
    const double sign = relative && a == 3 ? -1.0 : 1.0;
    errors.axis[a] = read_axis(top.table(kLetters[a]), sign);
  }
  return errors;
}

const std::map<std::string, GrinderErrors (*)()>& named_errors() {
  static const std::map<std::string, GrinderErrors (*)()> kNamed{
      {"none", [] { return GrinderErrors{}; }},
      {"p8", p8},
      {"p8-variation", p8_with_variation},
      {"table2", table_2},
      {"short-arm", short_arm},
      {"a-slope", a_slope}};
  return kNamed;
}

}  // namespace

bool GrinderErrors::waves() const {
  return std::any_of(axis.begin(), axis.end(), [](const AxisErrors& a) { return a.waves(); });
}

GrinderErrors parse_grinder_errors(const std::string& text, const std::string& name) {
  return host::read_toml(text, name, [&](const host::TomlValue& root) {
    return read_errors(host::TomlSection(root, name, "the file of errors"));
  });
}

bool is_named(const std::string& errors) { return named_errors().count(errors) > 0; }

GrinderErrors grinder_errors(const std::string& name_or_file) {
  const auto named = named_errors().find(name_or_file);
  if (named != named_errors().end()) return named->second();
  return parse_grinder_errors(host::text_of_file(name_or_file), name_or_file);
}

}  // namespace volcomp::l300g
