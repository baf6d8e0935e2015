#include "comp/metrology/fits/circle_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace volcomp {
namespace {

// Newton's method and Gauss-Newton converge in 3 to 8 steps; then steps are rounding.
constexpr int kMostSteps = 50;
constexpr double kConverged = 1e-14;  // relative to the root or the radius

// Means of products of the centred coordinates u, v and s = u² + v².
struct Moments {
  double uu = 0.0, vv = 0.0, uv = 0.0, us = 0.0, vs = 0.0, ss = 0.0;

  [[nodiscard]] double s() const { return uu + vv; }
  [[nodiscard]] double det() const { return uu * vv - uv * uv; }
};

class CentredPoints {
 public:
  CentredPoints(Span<const double> y, Span<const double> z) : y_(y), z_(z) {
    const auto n = static_cast<double>(y.size());
    for (std::size_t i = 0; i < y.size(); ++i) {
      mean_y_ += y[i] / n;
      mean_z_ += z[i] / n;
    }
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double a = u(i);
      const double b = v(i);
      const double s = a * a + b * b;
      m_.uu += a * a / n;
      m_.vv += b * b / n;
      m_.uv += a * b / n;
      m_.us += a * s / n;
      m_.vs += b * s / n;
      m_.ss += s * s / n;
    }
  }

  [[nodiscard]] std::size_t size() const { return y_.size(); }
  [[nodiscard]] double u(std::size_t i) const { return y_[i] - mean_y_; }
  [[nodiscard]] double v(std::size_t i) const { return z_[i] - mean_z_; }
  [[nodiscard]] const Moments& moments() const { return m_; }
  // A circle in centred coordinates, moved back.
  [[nodiscard]] Circle moved_back(Circle c) const {
    return {c.y + mean_y_, c.z + mean_z_, c.radius};
  }

 private:
  Span<const double> y_;
  Span<const double> z_;
  double mean_y_ = 0.0;
  double mean_z_ = 0.0;
  Moments m_;
};

// --- algebraic fits, all from the moments

struct Quartic {
  double a4, a3, a2, a1, a0;

  // The root nearest to 0 from below the first turning point: Newton's method from 0.
  [[nodiscard]] double smallest_root() const {
    double x = 0.0;
    for (int i = 0; i < kMostSteps; ++i) {
      const double value = a0 + x * (a1 + x * (a2 + x * (a3 + x * a4)));
      const double slope = a1 + x * (2.0 * a2 + x * (3.0 * a3 + x * 4.0 * a4));
      const double step = value / slope;
      if (!std::isfinite(step)) break;
      x -= step;
      if (std::abs(step) <= kConverged * std::abs(x)) break;
    }
    return x;
  }
};

// Centre and radius that belong to the root x; Kasa is x = 0. `widening`: 2 for Pratt.
Circle circle_of_root(const Moments& m, double x, double widening) {
  const double twice_det = 2.0 * (x * x - x * m.s() + m.det());
  const double y = (m.us * (m.vv - x) - m.vs * m.uv) / twice_det;
  const double z = (m.vs * (m.uu - x) - m.us * m.uv) / twice_det;
  return {y, z, std::sqrt(y * y + z * z + m.s() + widening * x)};
}

Circle pratt_circle(const Moments& m) {
  const double s = m.s();
  const Quartic q{4.0, 0.0, 4.0 * m.det() - 3.0 * s * s - m.ss,
                  m.ss * s + 4.0 * m.det() * s - m.us * m.us - m.vs * m.vs - s * s * s,
                  m.us * m.us * m.vv + m.vs * m.vs * m.uu - m.ss * m.det() -
                      2.0 * m.us * m.vs * m.uv + s * s * m.det()};
  return circle_of_root(m, q.smallest_root(), 2.0);
}

Circle taubin_circle(const Moments& m) {
  const double s = m.s();
  const double variance = m.ss - s * s;
  const Quartic q{
      0.0, 4.0 * s, -3.0 * s * s - m.ss,
      variance * s + 4.0 * m.det() * s - m.us * m.us - m.vs * m.vs,
      m.us * (m.us * m.vv - m.vs * m.uv) + m.vs * (m.vs * m.uu - m.us * m.uv) - variance * m.det()};
  return circle_of_root(m, q.smallest_root(), 0.0);
}

// --- geometric fit

struct NormalEquations {
  Mat3 matrix = Mat3::Zero();
  Vec3 right = Vec3::Zero();
};

NormalEquations linearised(const CentredPoints& points, const Circle& c) {
  NormalEquations eq;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double a = points.u(i) - c.y;
    const double b = points.v(i) - c.z;
    const double d = std::hypot(a, b);
    const Vec3 row(-a / d, -b / d, -1.0);  // of d − R
    eq.matrix += row * row.transpose();
    eq.right += row * (d - c.radius);
  }
  return eq;
}

Circle polished(const CentredPoints& points, Circle c) {
  for (int i = 0; i < kMostSteps; ++i) {
    const NormalEquations eq = linearised(points, c);
    const Vec3 step = -(eq.matrix.inverse() * eq.right);
    c = {c.y + step(0), c.z + step(1), c.radius + step(2)};
    if (step.norm() <= kConverged * c.radius) break;
  }
  return c;
}

void judge(const CentredPoints& points, const Circle& c, CircleFit& fit) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double residual = std::hypot(points.u(i) - c.y, points.v(i) - c.z) - c.radius;
    sum += residual * residual;
    if (std::abs(residual) <= std::abs(fit.largest)) continue;
    fit.largest = residual;
    fit.worst = i;
  }
  const std::size_t freedom = points.size() > 3 ? points.size() - 3 : 1;
  fit.rms = std::sqrt(sum / static_cast<double>(freedom));
  fit.cofactors = linearised(points, c).matrix.inverse();
}

Status check_numbers(Span<const double> y, Span<const double> z) {
  if (y.size() != z.size()) return refuse(Reason::length_mismatch);
  Where where;
  where.count = static_cast<int>(y.size());
  if (y.size() < 3) return refuse(Reason::too_few_points, where);
  for (std::size_t i = 0; i < y.size(); ++i) {
    Where at;
    at.index = static_cast<int>(i);
    if (!std::isfinite(y[i]) || !std::isfinite(z[i])) return refuse(Reason::not_finite, at);
  }
  return {};
}

bool all_alike(Span<const double> values) {
  const auto as_the_first = [first = values[0]](double v) { return !(v < first || v > first); };
  return std::all_of(values.begin(), values.end(), as_the_first);
}

Status check_shape(Span<const double> y, Span<const double> z, const Moments& m) {
  if (all_alike(y) && all_alike(z)) return refuse(Reason::coincident);
  const double det = m.det();
  const double trace = m.s();
  if (det <= 1e-10 * trace * trace / 4.0) return refuse(Reason::collinear);
  return {};
}

}  // namespace

Status fit_circle(Span<const double> y, Span<const double> z, CircleFit& out) {
  if (const Status s = check_numbers(y, z); !s.ok()) return s;
  const CentredPoints points(y, z);
  const Moments& m = points.moments();
  if (const Status s = check_shape(y, z, m); !s.ok()) return s;
  CircleFit fit;
  const Circle kasa = circle_of_root(m, 0.0, 0.0);
  const Circle geometric = polished(points, kasa);
  fit.kasa = points.moved_back(kasa);
  fit.pratt = points.moved_back(pratt_circle(m));
  fit.taubin = points.moved_back(taubin_circle(m));
  fit.geometric = points.moved_back(geometric);
  judge(points, geometric, fit);
  out = fit;
  return {};
}

}  // namespace volcomp
