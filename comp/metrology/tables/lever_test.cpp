#include "comp/metrology/tables/lever_test.hpp"

#include <cmath>

namespace volcomp {
namespace {

// Positioning difference and the two angles across the axis, all about their means.
struct Moments {
  double aa = 0.0, ab = 0.0, bb = 0.0, ad = 0.0, bd = 0.0, dd = 0.0;
};

struct Sample {
  double a;
  double b;
  double d;
};

Sample sample(Axis axis, const ErrorMotion& first, const ErrorMotion& second) {
  const auto i = static_cast<Eigen::Index>(axis);
  const Eigen::Index j = 3 + (i + 1) % 3;
  const Eigen::Index k = 3 + (i + 2) % 3;
  return {0.5 * (first(j) + second(j)), 0.5 * (first(k) + second(k)), second(i) - first(i)};
}

Moments moments(Axis axis, Span<const ErrorMotion> first, Span<const ErrorMotion> second) {
  Sample mean{0.0, 0.0, 0.0};
  const auto n = static_cast<double>(first.size());
  for (std::size_t t = 0; t < first.size(); ++t) {
    const Sample s = sample(axis, first[t], second[t]);
    mean = {mean.a + s.a / n, mean.b + s.b / n, mean.d + s.d / n};
  }
  Moments m;
  for (std::size_t t = 0; t < first.size(); ++t) {
    const Sample s = sample(axis, first[t], second[t]);
    const Sample c{s.a - mean.a, s.b - mean.b, s.d - mean.d};
    m.aa += c.a * c.a;
    m.ab += c.a * c.b;
    m.bb += c.b * c.b;
    m.ad += c.a * c.d;
    m.bd += c.b * c.d;
    m.dd += c.d * c.d;
  }
  return m;
}

}  // namespace

Status lever_self_test(Axis axis, Span<const ErrorMotion> first, Span<const ErrorMotion> second,
                       const Vec3& first_lever, const Vec3& second_lever, LeverTest& out) {
  const std::size_t n = first.size();
  if (n < 4 || second.size() != n) return refuse(Reason::too_few_points);
  const auto i = static_cast<Eigen::Index>(axis);
  const Vec3 difference = second_lever - first_lever;
  // x row of ε × L, cyclic: m_i = ε_j L_k − ε_k L_j.
  LeverTest test;
  test.expected = {difference((i + 2) % 3), -difference((i + 1) % 3)};
  const double span = std::hypot(test.expected[0], test.expected[1]);

  const Moments m = moments(axis, first, second);
  const double det = m.aa * m.bb - m.ab * m.ab;
  constexpr double kMinAngle_rad = 0.5e-6;  // rms; below this repeatability drowns the regression
  const double floor = static_cast<double>(n) * kMinAngle_rad * kMinAngle_rad;
  if (!(span > 0.0) || m.aa < floor || m.bb < floor || det < 1e-3 * m.aa * m.bb) {
    return refuse(Reason::lever_spread_too_small);
  }
  test.found = {(m.bb * m.ad - m.ab * m.bd) / det, (m.aa * m.bd - m.ab * m.ad) / det};
  const double residual = m.dd - test.found[0] * m.ad - test.found[1] * m.bd;
  const double variance = std::fmax(residual, 0.0) / static_cast<double>(n - 3);
  test.allowed = {0.05 * span + 3.0 * std::sqrt(variance * m.bb / det),
                  0.05 * span + 3.0 * std::sqrt(variance * m.aa / det)};
  out = test;
  for (std::size_t k = 0; k < 2; ++k) {
    const double deviation = test.found[k] - test.expected[k];
    if (std::abs(deviation) <= test.allowed[k]) continue;
    Where where;
    where.index = static_cast<int>(k);
    where.value = test.found[k];
    where.deviation = deviation;
    where.has_value = where.has_deviation = true;
    return refuse(Reason::lever_mismatch, where);
  }
  // Noise that hides half the lever would let a wrong unit or sign pass.
  const bool blind = std::fmax(test.allowed[0], test.allowed[1]) > 0.5 * span;
  return blind ? refuse(Reason::lever_spread_too_small) : Status{};
}

}  // namespace volcomp
