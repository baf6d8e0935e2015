#include "comp/metrology/gears/internal_gear_deviations.hpp"

#include <algorithm>

namespace volcomp {

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

}  // namespace volcomp
