#include "comp/evaluation/internal_gear_deviations.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp {
namespace {

Status check_positions(Span<const double> position) {
  Where where;
  where.count = static_cast<int>(position.size());
  if (position.size() < 2) return refuse(Reason::too_few_points, where);
  where.count = -1;
  for (std::size_t k = 0; k < position.size(); ++k) {
    where.index = static_cast<int>(k);
    if (!std::isfinite(position[k])) return refuse(Reason::not_finite, where);
  }
  return {};
}

}  // namespace

Status evaluate_internal_profile(Span<const double> roll_length, Span<const double> deviation,
                                 TraceDeviations& out) {
  if (roll_length.empty()) return evaluate_trace(roll_length, deviation, {}, out);
  const auto [low, high] = std::minmax_element(roll_length.begin(), roll_length.end());
  TraceDeviations d;
  if (const Status s = evaluate_trace(roll_length, deviation, {*low, *high}, d); !s.ok()) return s;
  d.slope = -d.slope;
  out = d;
  return {};
}

Status single_pitch_deviations(Span<const double> position, Span<double> single) {
  if (position.size() != single.size()) return refuse(Reason::length_mismatch);
  if (const Status s = check_positions(position); !s.ok()) return s;
  const std::size_t n = position.size();
  for (std::size_t k = 0; k < n; ++k)
    single[k] = position[k] - position[(k + n - 1) % n];
  return {};
}

Status sector_pitch_deviation(Span<const double> position, std::size_t k, double& out) {
  if (const Status s = check_positions(position); !s.ok()) return s;
  const std::size_t n = position.size();
  Where where;
  where.field = "k";
  where.value = static_cast<double>(k);
  where.has_value = true;
  if (k == 0 || k >= n) return refuse(Reason::bad_setting, where);
  double largest = 0.0;
  for (std::size_t j = 0; j < n; ++j)
    largest = std::max(largest, std::abs(position[(j + k) % n] - position[j]));
  out = largest;
  return {};
}

}  // namespace volcomp
