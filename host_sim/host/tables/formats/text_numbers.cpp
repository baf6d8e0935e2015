#include "host_sim/host/tables/formats/text_numbers.hpp"

#include <cmath>

#include <fmt/format.h>

namespace volcomp::host {
namespace {

// Finite and of the form; `where` has the index.
Status check_number(double value, const NumberForm& form, const char* field, Where where) {
  if (!std::isfinite(value)) return refuse(Reason::not_finite, where);
  if (std::abs(value) <= form.most) return {};
  where.field = field;
  where.has_value = true;
  where.value = value;
  return refuse(Reason::bad_setting, where);
}

}  // namespace

std::string six_decimals(double value) {
  std::string text = fmt::format("{:.6f}", value);
  return text == "-0.000000" ? "0.000000" : text;
}

long long nearest(double value) { return std::llround(value); }

Status check_offsets(const std::vector<double>& offsets, std::size_t capacity, bool modulo,
                     const NumberForm& form, double file_units) {
  Where where;
  where.count = static_cast<int>(offsets.size());
  if (offsets.size() < 2) return refuse(Reason::too_few_knots, where);
  if (offsets.size() > capacity) return refuse(Reason::too_many_knots, where);
  where.count = -1;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    where.index = static_cast<int>(i);
    const Status s = check_number(offsets[i] * file_units, form, "offset", where);
    if (!s.ok()) return s;
  }
  if (!modulo) return {};
  const double first = offsets.front() * file_units;
  const double last = offsets.back() * file_units;
  if (six_decimals(first) == six_decimals(last)) return {};
  where.has_deviation = true;
  where.deviation = last - first;
  return refuse(Reason::not_periodic, where);
}

bool fits_extent(double min, double step, std::size_t entries) {
  const double max = min + step * static_cast<double>(entries);
  return std::abs(min) <= kSixDecimals.most && std::abs(max) <= kSixDecimals.most;
}

Status check_nominal(const std::vector<double>& nominal, std::size_t offsets,
                     const NumberForm& form, double file_units) {
  if (nominal.size() != offsets) return refuse(Reason::length_mismatch);
  Where where;
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    where.index = static_cast<int>(i);
    const Status s = check_number(nominal[i] * file_units, form, "position", where);
    if (!s.ok()) return s;
    const auto printed = [&](double at) { return std::round(at * file_units * form.last_digits); };
    if (i == 0 || printed(nominal[i]) > printed(nominal[i - 1])) continue;
    const bool same = !(nominal[i] < nominal[i - 1]);
    return refuse(same ? Reason::positions_duplicate : Reason::positions_not_monotone, where);
  }
  return {};
}

}  // namespace volcomp::host
