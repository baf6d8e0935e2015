#include "host_sim/host/measure/uncertainty.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

using Member = std::optional<double> UncertaintyStatement::*;

struct Field {
  const char* key;
  Member member;
};

constexpr std::array<Field, 8> kFields{
    {{"device_um_per_m", &UncertaintyStatement::device_um_per_m},
     {"misalignment_mm", &UncertaintyStatement::misalignment_mm},
     {"expansion_um_per_m_K", &UncertaintyStatement::expansion_um_per_m_K},
     {"temperature_K", &UncertaintyStatement::temperature_K},
     {"expansion_limits_um_per_m_K", &UncertaintyStatement::expansion_limits_um_per_m_K},
     {"from_20_K", &UncertaintyStatement::from_20_K},
     {"eve_um", &UncertaintyStatement::eve_um},
     {"volume_um", &UncertaintyStatement::volume_um}}};

// Standard deviation of a value anywhere between two limits, by their distance.
double rectangular(double width) { return width / (2.0 * std::sqrt(3.0)); }

void need_both(bool first, bool second, const char* a, const char* b) {
  if (first != second)
    throw UserError(fmt::format("uncertainty: {} needs {}, too", first ? a : b, first ? b : a));
}

bool knows_temperature(const UncertaintyStatement& s) {
  return s.temperature_K && s.expansion_um_per_m_K;
}
bool knows_expansion(const UncertaintyStatement& s) {
  return s.expansion_limits_um_per_m_K && s.from_20_K;
}

// The cosine error of a diagonal lies between 0 and this: r² / 2 L.
double most_cosine_um(double misalignment_mm, double length_mm) {
  return 1e3 * misalignment_mm * misalignment_mm / (2.0 * length_mm);
}

// Along the diagonal: they stretch all of it, so they act on what is compared over its length.
void add_lengths(const UncertaintyStatement& s, double length_mm, std::vector<Contribution>& out) {
  const double length_m = 1e-3 * length_mm;
  if (s.device_um_per_m) out.push_back({"device", 0.5 * *s.device_um_per_m * length_m});
  if (s.misalignment_mm)
    out.push_back({"alignment", rectangular(most_cosine_um(*s.misalignment_mm, length_mm))});
  if (knows_temperature(s))
    out.push_back(
        {"temperature", *s.expansion_um_per_m_K * rectangular(2.0 * *s.temperature_K) * length_m});
  if (knows_expansion(s))
    out.push_back({"expansion coefficient",
                   *s.from_20_K * rectangular(2.0 * *s.expansion_limits_um_per_m_K) * length_m});
}

}  // namespace

UncertaintyStatement UncertaintyStatement::overridden_by(const UncertaintyStatement& other) const {
  UncertaintyStatement both = *this;
  for (const Field& f : kFields) {
    if (other.*f.member) both.*f.member = other.*f.member;
  }
  return both;
}

UncertaintyStatement parse_uncertainty(const std::string& text, const std::string& name) {
  return read_toml(text, name, [&name](const TomlValue& top) {
    const TomlSection all(top, name, "the file");
    all.allow_only({"uncertainty"});
    const TomlSection section = all.table("uncertainty");
    std::vector<std::string> keys;
    keys.reserve(kFields.size());
    for (const Field& f : kFields)
      keys.emplace_back(f.key);
    section.allow_only(keys);
    UncertaintyStatement s;
    for (const Field& f : kFields) {
      if (!section.has(f.key)) continue;
      const double value = section.number(f.key);
      if (value < 0.0) section.complain(f.key, fmt::format("'{}' must not be negative", f.key));
      s.*f.member = value;
    }
    return s;
  });
}

UncertaintyStatement read_uncertainty_file(const std::filesystem::path& path) {
  return parse_uncertainty(text_of_file(path), shown_name(path));
}

void require_complete(const UncertaintyStatement& s) {
  need_both(s.temperature_K.has_value(), s.expansion_um_per_m_K.has_value(), "temperature_K",
            "expansion_um_per_m_K");
  need_both(s.expansion_limits_um_per_m_K.has_value(), s.from_20_K.has_value(),
            "expansion_limits_um_per_m_K", "from_20_K");
}

std::vector<Contribution> contributions(const UncertaintyStatement& s, const Repetition& r,
                                        FigureKind figure) {
  std::vector<Contribution> out;
  const bool along = figure == FigureKind::largest || figure == FigureKind::systematic;
  if (along) add_lengths(s, r.length_mm, out);
  // The figure is the difference of two means of n readings, or of 2 n where it uses the means of
  // both directions; of single readings for R.
  const auto n = static_cast<double>(r.runs);
  const bool both = figure == FigureKind::largest && r.both_directions;
  const double difference = std::sqrt(2.0 / (both ? 2.0 * n : n));
  const bool repeatability = figure == FigureKind::repeatability;
  if (s.eve_um)
    out.push_back({"environmental variation",
                   rectangular(*s.eve_um) * (repeatability ? std::sqrt(2.0) : difference)});
  return out;
}

std::optional<double> expanded_um(const std::vector<Contribution>& contributions) {
  if (contributions.empty()) return std::nullopt;
  double squares = 0.0;
  for (const Contribution& c : contributions)
    squares += c.u_um * c.u_um;
  return 2.0 * std::sqrt(squares);
}

StatedErrors stated_errors(const UncertaintyStatement& s, double length_mm) {
  std::vector<Contribution> list;
  UncertaintyStatement aligned = s;
  aligned.misalignment_mm.reset();
  add_lengths(aligned, length_mm, list);
  double squares = 0.0;
  for (const Contribution& c : list)
    squares += c.u_um * c.u_um;
  if (s.misalignment_mm) {
    const double most = most_cosine_um(*s.misalignment_mm, length_mm);
    squares += most * most / 3.0;
  }
  return {std::sqrt(squares) / length_mm, s.eve_um.value_or(0.0)};
}

std::vector<StatedValue> stated_values(const UncertaintyStatement& s, bool of_diagonals,
                                       bool of_volume) {
  std::vector<StatedValue> list;
  for (const Field& f : kFields) {
    const bool wanted = f.member == &UncertaintyStatement::volume_um ? of_volume : of_diagonals;
    if (wanted && s.*f.member) list.push_back({f.key, *(s.*f.member)});
  }
  return list;
}

std::vector<std::string> left_out(const UncertaintyStatement& s, bool repeated) {
  std::vector<std::string> list;
  if (!s.device_um_per_m) list.emplace_back("device (device_um_per_m)");
  if (!s.misalignment_mm) list.emplace_back("alignment (misalignment_mm)");
  if (!knows_temperature(s)) list.emplace_back("temperature (temperature_K, expansion_um_per_m_K)");
  if (!knows_expansion(s))
    list.emplace_back("expansion coefficient (expansion_limits_um_per_m_K, from_20_K)");
  if (!s.eve_um) list.emplace_back("environmental variation (eve_um)");
  if (!repeated) list.emplace_back("repeatability (one run per direction)");
  return list;
}

}  // namespace volcomp::host
