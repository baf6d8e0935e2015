#include "host_sim/scenarios/xyfz/verification.hpp"

#include <Eigen/Cholesky>

namespace volcomp::sim {
namespace {

constexpr double kFeed_mm_s = 10000.0 / 60.0;
constexpr double kRapid_mm_s = 400.0;

}  // namespace

MeasuredDiagonal measure_diagonal(MotionCell& cell, const Diagonal& diagonal, std::size_t points,
                                  const InterferometerSetup& setup, Random& random) {
  MeasuredDiagonal m;
  m.name = diagonal.name;
  const Vec3 d = diagonal.direction();
  const double sigma = setup.repeatability_mm / std::sqrt(static_cast<double>(setup.runs));
  const auto read = [&](std::size_t j) {
    const double s = static_cast<double>(j) / static_cast<double>(points - 1);
    cell.move_to(diagonal.at(s), kFeed_mm_s);
    const double length = s * diagonal.length();
    return d.dot(cell.deviation_mm()) + setup.scale * length + random.normal(sigma);
  };
  std::vector<double> up(points);
  std::vector<double> down(points);
  cell.move_to(diagonal.start - 2.0 * d,
               kRapid_mm_s);  // overrun: the first point is approached like all others
  for (std::size_t j = 0; j < points; ++j)
    up[j] = read(j);
  cell.move_to(diagonal.end + 2.0 * d, kRapid_mm_s);
  for (std::size_t j = points; j > 0; --j)
    down[j - 1] = read(j - 1);

  const double zero = 0.5 * (up[0] + down[0]);
  for (std::size_t j = 0; j < points; ++j) {
    m.distance_mm.push_back(diagonal.length() * static_cast<double>(j) /
                            static_cast<double>(points - 1));
    m.mean_um.push_back(kUmPerMm * (0.5 * (up[j] + down[j]) - zero));
    m.reversal_um = std::max(m.reversal_um, kUmPerMm * std::abs(up[j] - down[j]));
  }
  const DiagonalFigures f = diagonal_figures({m.mean_um.data(), points});
  m.max_abs_um = f.max_abs;
  m.range_um = f.range;
  return m;
}

VolumeFigures measure_volume(MotionCell& cell, const DiagonalBox& box, int points,
                             std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> place;
  std::vector<Vec3> error;
  for (int i = 0; i < points; ++i) {
    Vec3 p;
    for (Eigen::Index k = 0; k < 3; ++k)
      p(k) = random.uniform(box.lo(k), box.hi(k));
    cell.move_to(p, kRapid_mm_s);
    place.push_back(p);
    error.push_back(cell.deviation_mm());
  }
  // error ≈ t + w × (p − c), least squares; lengths scaled so that the normal equations are well
  // conditioned.
  const Vec3 centre = 0.5 * (box.lo + box.hi);
  const double scale = 0.5 * (box.hi - box.lo).norm();
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Matrix6 normal = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  const auto row = [&](const Vec3& p) {
    Eigen::Matrix<double, 3, 6> A;
    A << Mat3::Identity(), -cross_matrix((p - centre) / scale);
    return A;
  };
  for (std::size_t i = 0; i < place.size(); ++i) {
    const auto A = row(place[i]);
    normal += A.transpose() * A;
    right += A.transpose() * error[i];
  }
  const Vector6 rigid = normal.llt().solve(right);
  VolumeFigures f;
  double squares = 0.0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    const double rest = (error[i] - row(place[i]) * rigid).norm();
    f.max_um = std::max(f.max_um, kUmPerMm * rest);
    squares += rest * rest;
  }
  f.rms_um = kUmPerMm * std::sqrt(squares / static_cast<double>(place.size()));
  return f;
}

}  // namespace volcomp::sim
