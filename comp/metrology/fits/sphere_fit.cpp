#include "comp/metrology/fits/sphere_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace volcomp {
namespace {

using Vec4 = Eigen::Matrix<double, 4, 1>;
using Mat4 = Eigen::Matrix<double, 4, 4>;

constexpr int kMostSteps = 50;
constexpr double kConverged = 1e-14;  // relative to the radius
constexpr double kFlat = 1e-10;       // smallest over largest principal moment

struct Centred {
  Span<const Vec3> points;
  Vec3 mean = Vec3::Zero();
  Mat3 moments = Mat3::Zero();  // mean of u uᵀ
  Vec3 cubic = Vec3::Zero();    // mean of u |u|²

  [[nodiscard]] Vec3 u(std::size_t i) const { return points[i] - mean; }
};

Centred centred(Span<const Vec3> points) {
  Centred c;
  c.points = points;
  const auto n = static_cast<double>(points.size());
  for (const Vec3& p : points)
    c.mean += p / n;
  for (const Vec3& p : points) {
    const Vec3 u = p - c.mean;
    c.moments += u * u.transpose() / n;
    c.cubic += u * (u.squaredNorm() / n);
  }
  return c;
}

// Kasa's, the start: least Σ(d² − R²)² about the mean needs 2 M c = Σ u|u|².
Sphere algebraic(const Centred& c) {
  Sphere s;
  s.centre = 0.5 * (c.moments.inverse() * c.cubic);
  s.radius = std::sqrt(s.centre.squaredNorm() + c.moments.trace());
  return s;
}

struct NormalEquations {
  Mat4 matrix = Mat4::Zero();
  Vec4 right = Vec4::Zero();
};

NormalEquations linearised(const Centred& c, const Sphere& s) {
  NormalEquations eq;
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const Vec3 v = c.u(i) - s.centre;
    const double d = v.norm();
    Vec4 row;
    row << -v / d, -1.0;  // of d − R
    eq.matrix += row * row.transpose();
    eq.right += row * (d - s.radius);
  }
  return eq;
}

Sphere polished(const Centred& c, Sphere s) {
  for (int i = 0; i < kMostSteps; ++i) {
    const NormalEquations eq = linearised(c, s);
    const Vec4 step = -(eq.matrix.inverse() * eq.right);
    s.centre += step.head<3>();
    s.radius += step[3];
    if (step.norm() <= kConverged * s.radius) break;
  }
  return s;
}

void judge(const Centred& c, const Sphere& s, SphereFit& fit) {
  double sum = 0.0;
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const double residual = (c.u(i) - s.centre).norm() - s.radius;
    sum += residual * residual;
    if (std::abs(residual) <= std::abs(fit.largest)) continue;
    fit.largest = residual;
    fit.worst = i;
  }
  const std::size_t freedom = c.points.size() > 4 ? c.points.size() - 4 : 1;
  fit.rms = std::sqrt(sum / static_cast<double>(freedom));
  fit.cofactors = linearised(c, s).matrix.inverse();
}

Status check_numbers(Span<const Vec3> points) {
  Where where;
  where.count = static_cast<int>(points.size());
  if (points.size() < 4) return refuse(Reason::too_few_points, where);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Where at;
    at.index = static_cast<int>(i);
    if (!points[i].allFinite()) return refuse(Reason::not_finite, at);
  }
  return {};
}

bool all_alike(Span<const Vec3> points) {
  return std::all_of(points.begin(), points.end(), [&points](const Vec3& p) {
    return (p - points[0]).cwiseAbs().maxCoeff() <= 0.0;
  });
}

// Points in a plane lie on a circle, which belongs to many spheres. In invariants of the moments:
// their determinant and the sum of the principal minors are products of principal moments.
Status check_shape(const Centred& c) {
  const Mat3& m = c.moments;
  const double trace = m.trace();
  if (all_alike(c.points)) return refuse(Reason::coincident);
  const double minors = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0) + m(1, 1) * m(2, 2) -
                        m(1, 2) * m(2, 1) + m(0, 0) * m(2, 2) - m(0, 2) * m(2, 0);
  Where where;
  where.count = 2;
  if (minors <= kFlat * trace * trace) return refuse(Reason::rank_deficient, where);
  where.count = 3;
  if (m.determinant() <= kFlat * minors * trace) return refuse(Reason::rank_deficient, where);
  return {};
}

}  // namespace

Status fit_sphere(Span<const Vec3> points, SphereFit& out) {
  if (const Status s = check_numbers(points); !s.ok()) return s;
  const Centred c = centred(points);
  if (const Status s = check_shape(c); !s.ok()) return s;
  SphereFit fit;
  const Sphere sphere = polished(c, algebraic(c));
  fit.sphere = {sphere.centre + c.mean, sphere.radius};
  judge(c, sphere, fit);
  out = fit;
  return {};
}

}  // namespace volcomp
