#include "comp/metrology/circles/circle_test.hpp"

#include <cmath>

namespace volcomp {
namespace {

Status check_finite(Span<const double> values, const char* direction, const char* field) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    Where where;
    where.direction = direction;
    where.field = field;
    where.index = static_cast<int>(i);
    return refuse(Reason::not_finite, where);
  }
  return {};
}

Status check_trace(const CircleTrace& trace, const char* direction) {
  if (trace.theta.size() != trace.radial.size()) {
    Where where;
    where.direction = direction;
    return refuse(Reason::length_mismatch, where);
  }
  if (const Status s = check_finite(trace.theta, direction, "theta"); !s.ok()) return s;
  return check_finite(trace.radial, direction, "radial");
}

}  // namespace

Status check_readings(const CircleTest& test, std::size_t least) {
  if (const Status s = check_trace(test.ccw, "ccw"); !s.ok()) return s;
  if (const Status s = check_trace(test.cw, "cw"); !s.ok()) return s;
  const std::size_t readings = test.ccw.theta.size() + test.cw.theta.size();
  if (readings >= least) return {};
  Where where;
  where.count = static_cast<int>(readings);
  return refuse(Reason::too_few_points, where);
}

}  // namespace volcomp
