#include "host_sim/sim/campaign/measured_diagonals.hpp"

namespace volcomp::sim {
namespace {

constexpr double kFeed_mm_s = 10000.0 / 60.0;
constexpr double kRapid_mm_s = 400.0;

// `pose_of`: of coordinates; `along`: direction in which the tool goes, work frame.
template <class PoseOf>
DiagonalPass go_along(MotionCell& cell, const PoseOf& pose_of, const Diagonal& diagonal,
                      const Vec3& along, std::size_t points,
                      const std::function<double(double)>& reading_error) {
  const Vec3 d = diagonal.direction();
  const auto read = [&](std::size_t j) {
    const double s = static_cast<double>(j) / static_cast<double>(points - 1);
    cell.move_to(pose_of(diagonal.at(s)), kFeed_mm_s);
    return along.dot(cell.deviation_mm()) + reading_error(s * diagonal.length());
  };
  DiagonalPass pass{std::vector<double>(points), std::vector<double>(points)};
  // Overrun: the first point is approached like all others.
  cell.move_to(pose_of(diagonal.start - 2.0 * d), kRapid_mm_s);
  for (std::size_t j = 0; j < points; ++j)
    pass.up[j] = read(j);
  cell.move_to(pose_of(diagonal.end + 2.0 * d), kRapid_mm_s);
  for (std::size_t j = points; j > 0; --j)
    pass.down[j - 1] = read(j - 1);
  return pass;
}

template <class PoseOf, class InWork>
std::vector<host::VolumePoint> visit(MotionCell& cell, const PoseOf& pose_of, const InWork& in_work,
                                     const DiagonalBox& box, int points, std::uint64_t seed) {
  Random random(seed);
  std::vector<host::VolumePoint> visited;
  for (int i = 0; i < points; ++i) {
    Vec3 at;
    for (Eigen::Index k = 0; k < 3; ++k)
      at(k) = random.uniform(box.lo(k), box.hi(k));
    cell.move_to(pose_of(at), kRapid_mm_s);
    host::VolumePoint p;
    p.at_mm = in_work(at);
    p.error_mm = cell.deviation_mm();
    visited.push_back(p);
  }
  return visited;
}

}  // namespace

DiagonalPass pass_along(MotionCell& cell, const host::XyzAxes& axes, const Diagonal& diagonal,
                        std::size_t points, const std::function<double(double)>& reading_error) {
  const auto pose_of = [&](const Vec3& at) { return axes.pose(at); };
  const Vec3 along = axes.in_work(diagonal.end - diagonal.start).normalized();
  return go_along(cell, pose_of, diagonal, along, points, reading_error);
}

MeasuredDiagonal mean_of_directions(const std::string& name, double length_mm,
                                    const DiagonalPass& pass) {
  const std::vector<double>& up = pass.up;
  const std::vector<double>& down = pass.down;
  const std::size_t points = up.size();
  const double first = 0.5 * (up.front() + down.front());
  MeasuredDiagonal m;
  m.name = name;
  for (std::size_t j = 0; j < points; ++j) {
    m.distance_mm.push_back(length_mm * static_cast<double>(j) / static_cast<double>(points - 1));
    m.mean_um.push_back(kUmPerMm * (0.5 * (up[j] + down[j]) - first));
    m.reversal_um = std::max(m.reversal_um, kUmPerMm * std::abs(up[j] - down[j]));
  }
  const DiagonalFigures figures = diagonal_figures({m.mean_um.data(), points});
  m.max_abs_um = figures.max_abs;
  m.range_um = figures.range;
  return m;
}

MeasuredDiagonal measure_diagonal(MotionCell& cell, const Diagonal& diagonal, std::size_t points,
                                  const InterferometerSetup& setup, Random& random) {
  const double sigma = setup.repeatability_mm / std::sqrt(static_cast<double>(setup.runs));
  const auto reading_error = [&](double length_mm) {
    return setup.scale * length_mm + random.normal(sigma);
  };
  const DiagonalPass pass =
      go_along(cell, host::pose_of, diagonal, diagonal.direction(), points, reading_error);
  return mean_of_directions(diagonal.name, diagonal.length(), pass);
}

std::vector<host::VolumePoint> visit_volume(MotionCell& cell, const host::XyzAxes& axes, int points,
                                            std::uint64_t seed) {
  const auto pose_of = [&](const Vec3& at) { return axes.pose(at); };
  const auto in_work = [&](const Vec3& at) { return axes.in_work(at); };
  return visit(cell, pose_of, in_work, axes.travel(), points, seed);
}

host::VolumeFigures measure_volume(MotionCell& cell, const DiagonalBox& box, int points,
                                   std::uint64_t seed) {
  const auto as_it_is = [](const Vec3& at) { return at; };
  return host::aligned_volume_figures(visit(cell, host::pose_of, as_it_is, box, points, seed));
}

}  // namespace volcomp::sim
