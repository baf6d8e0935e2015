#include "host_sim/sim/campaign/measured_diagonals.hpp"

namespace volcomp::sim {
namespace {

constexpr double kRapid_mm_s = 400.0;
constexpr double kOverrun_mm = 2.0;

MeasuredLine straight(const Diagonal& diagonal, const Pose& start, const Pose& end,
                      const Vec3& along, std::size_t points) {
  return {diagonal.name, start, end, along, diagonal.length(), points};
}

}  // namespace

MeasuredLine line_of(const host::XyzAxes& axes, const Diagonal& diagonal, std::size_t points) {
  return straight(diagonal, axes.pose(diagonal.start), axes.pose(diagonal.end),
                  axes.in_work(diagonal.end - diagonal.start).normalized(), points);
}

DiagonalPass pass_along(MotionCell& cell, const MeasuredLine& line,
                        const std::function<double(double)>& read) {
  const auto at = [&](double s) {
    Pose q = line.start;
    for (std::size_t a = 0; a < q.size(); ++a)
      q[a] += s * (line.end[a] - line.start[a]);
    return q;
  };
  const auto read_at = [&](std::size_t j) {
    const double s = static_cast<double>(j) / static_cast<double>(line.points - 1);
    cell.move_to(at(s), line.feed_mm_s);
    return read(s * line.length_mm);
  };
  DiagonalPass pass{std::vector<double>(line.points), std::vector<double>(line.points)};
  cell.move_to(at(-kOverrun_mm / line.length_mm), kRapid_mm_s);
  for (std::size_t j = 0; j < line.points; ++j)
    pass.up[j] = read_at(j);
  cell.move_to(at(1.0 + kOverrun_mm / line.length_mm), kRapid_mm_s);
  for (std::size_t j = line.points; j > 0; --j)
    pass.down[j - 1] = read_at(j - 1);
  return pass;
}

MeasuredDiagonal mean_of_directions(const MeasuredLine& line, const DiagonalPass& pass) {
  const std::vector<double>& up = pass.up;
  const std::vector<double>& down = pass.down;
  const auto last = static_cast<double>(line.points - 1);
  const double first = 0.5 * (up.front() + down.front());
  MeasuredDiagonal m;
  m.name = line.name;
  for (std::size_t j = 0; j < line.points; ++j) {
    m.distance_mm.push_back(line.length_mm * static_cast<double>(j) / last);
    m.mean_um.push_back(kUmPerMm * (0.5 * (up[j] + down[j]) - first));
    m.reversal_um = std::max(m.reversal_um, kUmPerMm * std::abs(up[j] - down[j]));
  }
  const DiagonalFigures figures = diagonal_figures({m.mean_um.data(), line.points});
  m.max_abs_um = figures.max_abs;
  m.range_um = figures.range;
  return m;
}

MeasuredDiagonal measure_diagonal(MotionCell& cell, const Diagonal& diagonal, std::size_t points,
                                  const InterferometerSetup& setup, Random& random) {
  const double sigma = setup.repeatability_mm / std::sqrt(static_cast<double>(setup.runs));
  const MeasuredLine line = straight(diagonal, host::pose_of(diagonal.start),
                                     host::pose_of(diagonal.end), diagonal.direction(), points);
  return mean_of_directions(line, pass_along(cell, line, [&](double at_mm) {
                              return line.along.dot(cell.deviation_mm()) + setup.scale * at_mm +
                                     random.normal(sigma);
                            }));
}

std::vector<host::VolumePoint> visit_volume(MotionCell& cell, const host::XyzAxes& axes, int points,
                                            std::uint64_t seed) {
  const DiagonalBox& box = axes.travel();
  Random random(seed);
  std::vector<host::VolumePoint> visited;
  for (int i = 0; i < points; ++i) {
    Vec3 at;
    for (Eigen::Index k = 0; k < 3; ++k)
      at(k) = random.uniform(box.lo(k), box.hi(k));
    cell.move_to(axes.pose(at), kRapid_mm_s);
    host::VolumePoint p;
    p.at_mm = axes.in_work(at);
    p.error_mm = cell.deviation_mm();
    visited.push_back(p);
  }
  return visited;
}

}  // namespace volcomp::sim
