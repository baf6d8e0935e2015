#include "comp/metrology/gears/gear_deviations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace volcomp {
namespace {

constexpr double kEnd = 1e-9;  // a point at the end of the range belongs to it

class Spread {
 public:
  void add(double value) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  [[nodiscard]] double range() const { return high_ - low_; }

 private:
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
};

// The points of a trace that count.
class Counted {
 public:
  Counted(Span<const double> at, Span<const double> deviation, const EvaluationRange& range)
      : at_(at), deviation_(deviation), range_(range) {}

  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      if (at_[i] >= range_.low - kEnd && at_[i] <= range_.high + kEnd) visit(at_[i], deviation_[i]);
    }
  }

 private:
  Span<const double> at_;
  Span<const double> deviation_;
  EvaluationRange range_;
};

struct Line {
  double mean_at = 0.0;
  double mean = 0.0;
  double slope = 0.0;

  [[nodiscard]] double residual(double at, double value) const {
    return value - mean - slope * (at - mean_at);
  }
};

Line mean_line(const Counted& points, double n) {
  Line line;
  points.each([&](double at, double value) {
    line.mean_at += at / n;
    line.mean += value / n;
  });
  double xx = 0.0;
  double xy = 0.0;
  points.each([&](double at, double value) {
    xx += (at - line.mean_at) * (at - line.mean_at);
    xy += (at - line.mean_at) * (value - line.mean);
  });
  line.slope = xx > 0.0 ? xy / xx : 0.0;
  return line;
}

Status check_finite(Span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    Where where;
    where.index = static_cast<int>(i);
    if (!std::isfinite(values[i])) return refuse(Reason::not_finite, where);
  }
  return {};
}

Status too_few(std::size_t count) {
  Where where;
  where.count = static_cast<int>(count);
  return refuse(Reason::too_few_points, where);
}

}  // namespace

Status evaluate_trace(Span<const double> at, Span<const double> deviation,
                      const EvaluationRange& range, TraceDeviations& out) {
  if (at.size() != deviation.size()) return refuse(Reason::length_mismatch);
  if (const Status s = check_finite(at); !s.ok()) return s;
  if (const Status s = check_finite(deviation); !s.ok()) return s;
  const Counted points(at, deviation, range);
  TraceDeviations d;
  points.each([&](double, double) { ++d.used; });
  if (d.used < 3) return too_few(d.used);
  const Line line = mean_line(points, static_cast<double>(d.used));
  Spread total;
  Spread form;
  points.each([&](double x, double value) {
    total.add(value);
    form.add(line.residual(x, value));
  });
  d.total = total.range();
  d.form = form.range();
  d.slope = line.slope * (range.high - range.low);
  out = d;
  return {};
}

}  // namespace volcomp
