#pragma once
// A face gear by closed forms (docs/papers/face-gear.md), written for tests only: points, normals
// and signed distances, independent of the code under test.

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "comp/core/units.hpp"
#include "comp/metrology/faces/measuring_grid.hpp"

namespace volcomp::reference {

struct Relief {
  double z0 = 0.0;
  double length = 0.0;
  double amplitude = 0.0;
};

struct FaceGear {
  double shaper_teeth = 25.0;
  double teeth = 86.0;
  double module = 4.0;
  double pressure_angle = 25.0 * kPi / 180.0;
  std::optional<Relief> relief;

  [[nodiscard]] double i() const { return shaper_teeth / teeth; }
  [[nodiscard]] double r_bs() const {
    return 0.5 * module * shaper_teeth * std::cos(pressure_angle);
  }
  [[nodiscard]] double arm() const { return r_bs() / i(); }  // C
  [[nodiscard]] double theta0() const {
    return kPi / (2.0 * shaper_teeth) + std::tan(pressure_angle) - pressure_angle;
  }
};

// The gear of the paper's Table 3 (docs/papers/face-gear.md).
inline FaceGear gear_of_table_3() {
  FaceGear gear;
  gear.relief = Relief{48.4, 2.4, 0.060};
  return gear;
}

inline Vec3 mirrored(const Vec3& v) { return {v.x(), -v.y(), v.z()}; }

struct Parameters {
  double theta = 0.0;
  double beta = 0.0;
};

// Side +1, slot 0, without relief; with the tangents by theta and beta.
struct BasePoint {
  Vec3 point, normal, by_theta, by_beta;
  double t = 0.0, u = 0.0;
  Vec3 e1, e2;
};

inline BasePoint base_point(const FaceGear& g, const Parameters& p) {
  const double cb = std::cos(p.beta);
  const double sb = std::sin(p.beta);
  const double phi2 = g.i() * (p.theta - g.theta0() - p.beta);
  BasePoint b;
  b.u = g.arm() / cb;
  b.t = g.r_bs() * (p.theta * cb - sb);
  const double d = g.r_bs() * (cb + p.theta * sb);
  const double c = std::cos(phi2);
  const double s = std::sin(phi2);
  b.point = {b.u * c + b.t * s, -b.u * s + b.t * c, d};
  b.normal = {-cb * s, -cb * c, -sb};
  b.e1 = {c, -s, 0.0};
  b.e2 = {-sb * s, -sb * c, cb};
  b.by_theta = g.i() * b.t * b.e1 + g.r_bs() * sb / cb * b.e2;
  b.by_beta = (b.u * sb / cb - g.i() * b.t) * b.e1 + b.t / cb * b.e2;
  return b;
}

// With the relief of the gear, if it has one.
inline SurfacePoint flank_point(const FaceGear& g, const Parameters& p) {
  const BasePoint b = base_point(g, p);
  SurfacePoint s{b.point, b.normal};
  if (!g.relief || b.point.z() >= g.relief->z0) return s;
  const double in = (g.relief->z0 - b.point.z()) / g.relief->length;
  const double depth = g.relief->amplitude * in * in;
  const double by_z = -2.0 * g.relief->amplitude * in / g.relief->length;
  const double cb = std::cos(p.beta);
  const double sb = std::sin(p.beta);
  const Vec3 by_theta = (g.i() * b.t + depth * g.i() * cb) * b.e1 + g.r_bs() * sb / cb * b.e2 -
                        by_z * g.r_bs() * sb * b.normal;
  const Vec3 by_beta = (b.u * sb / cb - g.i() * b.t - depth * g.i() * cb) * b.e1 +
                       (b.t / cb + depth) * b.e2 - by_z * b.t * b.normal;
  s.point = b.point - depth * b.normal;
  s.normal = -by_theta.cross(by_beta).normalized();
  if (s.normal.dot(b.normal) < 0.0) s.normal = -s.normal;
  return s;
}

// The base flank through (x, z): Newton in theta and beta.
inline Parameters parameters_at(const FaceGear& g, double x, double z) {
  Parameters p{0.4, 0.45};
  for (int k = 0; k < 30; ++k) {
    const BasePoint b = base_point(g, p);
    const double dx = x - b.point.x();
    const double dz = z - b.point.z();
    const double det = b.by_theta.x() * b.by_beta.z() - b.by_beta.x() * b.by_theta.z();
    p.theta += (dx * b.by_beta.z() - b.by_beta.x() * dz) / det;
    p.beta += (b.by_theta.x() * dz - dx * b.by_theta.z()) / det;
  }
  return p;
}

// Heights of the base flank in the rows of Table 3: 46.6, 47.5, 48.4, then equal steps to a last
// one that rises along the face width.
inline double table_3_height(std::size_t row, std::size_t column) {
  if (row < 3) return 46.6 + 0.9 * static_cast<double>(row);
  const double last = 51.285 + (54.3142 - 51.285) * static_cast<double>(column) / 14.0;
  return 48.4 + (last - 48.4) * (static_cast<double>(row) - 2.0) / 4.0;
}

// Parameters of the nodes of Table 3's grid.
inline std::array<Parameters, kGridCells> table_3_parameters(const FaceGear& g) {
  std::array<Parameters, kGridCells> grid;
  for (std::size_t row = 0; row < kGridRows; ++row) {
    for (std::size_t column = 0; column < kGridColumns; ++column)
      grid[grid_index(row, column)] = parameters_at(
          g, 162.5 + 20.0 * static_cast<double>(column) / 14.0, table_3_height(row, column));
  }
  return grid;
}

// Points and normals of Table 3's grid on side +1 or −1.
inline std::array<SurfacePoint, kGridCells> table_3_grid(const FaceGear& g, int side = 1) {
  std::array<SurfacePoint, kGridCells> grid;
  const auto parameters = table_3_parameters(g);
  for (std::size_t i = 0; i < kGridCells; ++i) {
    grid[i] = flank_point(g, parameters[i]);
    if (side < 0) grid[i] = {mirrored(grid[i].point), mirrored(grid[i].normal)};
  }
  return grid;
}

inline std::array<Vec3, kGridCells> points_of(const std::array<SurfacePoint, kGridCells>& grid) {
  std::array<Vec3, kGridCells> points;
  for (std::size_t i = 0; i < kGridCells; ++i)
    points[i] = grid[i].point;
  return points;
}

// Signed distance of a point from a flank without relief.
inline double distance(const FaceGear& g, const Vec3& q, int side, int slot) {
  const double rho = std::hypot(q.x(), q.y());
  double c = g.arm() / rho;
  double s = 0.0;
  double t = 0.0;
  for (int k = 0; k < 60; ++k) {
    s = std::sqrt(1.0 - c * c);
    t = (q.z() * c - g.r_bs()) / s;
    const double f = g.arm() * g.arm() / (c * c) + t * t - rho * rho;
    const double slope =
        -2.0 * g.arm() * g.arm() / (c * c * c) + 2.0 * t * (q.z() / s + t * c / (s * s));
    c -= f / slope;
  }
  s = std::sqrt(1.0 - c * c);
  t = (q.z() * c - g.r_bs()) / s;
  const double theta = (t + g.r_bs() * s) / (g.r_bs() * c);
  const double zeta = std::atan2(t, g.arm() / c) - g.i() * (theta - g.theta0() - std::acos(c));
  const double angle = std::atan2(q.y(), q.x()) - 2.0 * kPi * slot / g.teeth;
  return g.arm() * (zeta - side * std::remainder(angle, 2.0 * kPi));
}

inline int nearest_slot(const FaceGear& g, const Vec3& q) {
  return static_cast<int>(std::lround(std::atan2(q.y(), q.x()) * g.teeth / (2.0 * kPi)));
}

}  // namespace volcomp::reference
