#include "comp/metrology/gears/trace_filter.hpp"

#include <cmath>

namespace volcomp {
namespace {

Status check_finite(Span<const double> values, const char* field) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    Where where;
    where.field = field;
    where.index = static_cast<int>(i);
    return refuse(Reason::not_finite, where);
  }
  return {};
}

Status check(Span<const double> at, Span<const double> deviation, double cutoff,
             Span<const double> out) {
  constexpr std::size_t kLeast = 3;
  if (at.size() != deviation.size() || out.size() != at.size())
    return refuse(Reason::length_mismatch);
  if (const Status s = check_finite(at, "at"); !s.ok()) return s;
  if (const Status s = check_finite(deviation, "deviation"); !s.ok()) return s;
  Where where;
  where.count = static_cast<int>(at.size());
  if (at.size() < kLeast) return refuse(Reason::too_few_points, where);
  where = {};
  for (std::size_t i = 1; i < at.size(); ++i) {
    where.index = static_cast<int>(i);
    if (!(at[i] > at[i - 1])) return refuse(Reason::positions_not_monotone, where);
  }
  if (!(cutoff > 0.0) || !std::isfinite(cutoff))
    return refuse_value(Reason::bad_setting, "cutoff", cutoff);
  for (std::size_t i = 1; i < at.size(); ++i) {
    where.index = static_cast<int>(i);
    if (at[i] - at[i - 1] > 0.5 * cutoff) return refuse(Reason::gap, where);
  }
  return {};
}

// Half of the way to the neighbours: what a point stands for.
double share(Span<const double> at, std::size_t j) {
  const std::size_t before = j > 0 ? j - 1 : j;
  const std::size_t after = j + 1 < at.size() ? j + 1 : j;
  return 0.5 * (at[after] - at[before]);
}

// Weighted regression about one place.
class Regression {
 public:
  void add(double weight, double away, double value) {
    s0_ += weight;
    s1_ += weight * away;
    s2_ += weight * away * away;
    t0_ += weight * value;
    t1_ += weight * away * value;
  }
  [[nodiscard]] double value(FilterOrder order) const {
    if (order == FilterOrder::mean) return t0_ / s0_;
    return (s2_ * t0_ - s1_ * t1_) / (s0_ * s2_ - s1_ * s1_);
  }

 private:
  double s0_ = 0.0, s1_ = 0.0, s2_ = 0.0, t0_ = 0.0, t1_ = 0.0;
};

}  // namespace

Status filter_trace(Span<const double> at, Span<const double> deviation, double cutoff,
                    FilterOrder order, Span<double> out) {
  if (const Status s = check(at, deviation, cutoff, {out.data(), out.size()}); !s.ok()) return s;
  // exp(−π(x/αλ)²) with α² = ln 2/π: half the amplitude at λ.
  constexpr double kPi = 3.141592653589793;
  const double bend = kPi * kPi / (std::log(2.0) * cutoff * cutoff);
  for (std::size_t i = 0; i < at.size(); ++i) {
    Regression about;
    for (std::size_t j = 0; j < at.size(); ++j) {
      const double away = at[j] - at[i];
      about.add(std::exp(-bend * away * away) * share(at, j), away, deviation[j]);
    }
    out[i] = about.value(order);
  }
  return {};
}

}  // namespace volcomp
