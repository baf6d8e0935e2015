#include "host_sim/host/measure/identify/volume.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::host::identify {
namespace {

// About which point rigid motions turn, and the length that makes turns as large as shifts.
struct Pivot {
  Vec3 mean = Vec3::Zero();
  double size = 0.0;
};

Pivot pivot_of(const std::vector<Vec3>& points) {
  Pivot pivot;
  for (const Vec3& p : points)
    pivot.mean += p / static_cast<double>(points.size());
  for (const Vec3& p : points)
    pivot.size = std::max(pivot.size, (p - pivot.mean).norm());
  if (!(pivot.size > 0.0)) pivot.size = 1.0;
  return pivot;
}

// What the six rigid motions do at points, three rows each.
MatrixXd motions_at(const Pivot& pivot, const std::vector<Vec3>& points) {
  MatrixXd motions(static_cast<Index>(3 * points.size()), 6);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Index>(3 * i);
    motions.block<3, 3>(row, 0).setIdentity();
    motions.block<3, 3>(row, 3) = -cross_matrix((points[i] - pivot.mean) / pivot.size);
  }
  return motions;
}

// Orthonormal columns that span the rigid motions of points.
MatrixXd rigid_motions(const std::vector<Vec3>& points) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(motions_at(pivot_of(points), points));
  return MatrixXd(qr.householderQ()).leftCols(qr.rank());
}

// ∂E/∂x of a point at all places, three rows each; unknowns of the machine alone.
MatrixXd error_rows(const Equations& equations, const VolumePlaces& places, const Vec3& tool_point,
                    std::vector<Vec3>& points) {
  const Unknowns& unknowns = equations.unknowns();
  const MachineChain& chain = equations.problem().machine.chain;
  MatrixXd L(static_cast<Index>(3 * places.q.size()), unknowns.size());
  VectorXd row(unknowns.size());
  for (std::size_t i = 0; i < places.q.size(); ++i) {
    const ChainGeometry g = ideal_geometry(chain, places.q[i]);
    points.push_back(g.in_work(tool_point));
    const Vec3 base = g.tool.apply(tool_point);
    for (Index k = 0; k < 3; ++k) {
      row.setZero();
      for (std::size_t a = 0; a < chain.axis_count(); ++a) {
        const ErrorEffect effect = g.work.R.transpose() * point_effect(g, a, base);
        unknowns.add_errors(a, places.q[i].at(a), places.d.empty() ? 0.0 : places.d[i].at(a),
                            effect.row(k), row);
      }
      L.row(static_cast<Index>(3 * i) + k) = row.transpose();
    }
  }
  return L;
}

// Root of the trace of the covariance of each three rows.
std::vector<double> roots_of_traces(const Triangle& triangle, const MatrixXd& rows) {
  const MatrixXd reduced =
      triangle.R().transpose().triangularView<Eigen::Lower>().solve(rows.transpose());
  std::vector<double> u;
  for (Index i = 0; i < reduced.cols(); i += 3)
    u.push_back(reduced.middleCols(i, 3).norm());
  return u;
}

double rms_of(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double v : values)
    squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

std::vector<Vec3> without_rigid(const std::vector<Vec3>& points, const std::vector<Vec3>& errors) {
  const MatrixXd Q = rigid_motions(points);
  VectorXd e(static_cast<Index>(3 * errors.size()));
  for (std::size_t i = 0; i < errors.size(); ++i)
    e.segment<3>(static_cast<Index>(3 * i)) = errors[i];
  e -= Q * (Q.transpose() * e);
  std::vector<Vec3> left;
  for (std::size_t i = 0; i < errors.size(); ++i)
    left.emplace_back(e.segment<3>(static_cast<Index>(3 * i)));
  return left;
}

double VolumeUncertainty::rms_rigid() const { return rms_of(rigid); }

VolumeUncertainty volume_uncertainty(const Equations& equations, const Triangle& triangle,
                                     const VolumePlaces& places, const Vec3& tool_point) {
  std::vector<Vec3> points;
  const MatrixXd L = error_rows(equations, places, tool_point, points);
  VolumeUncertainty u;
  u.datum = roots_of_traces(triangle, L);
  const MatrixXd Q = rigid_motions(points);
  u.rigid = roots_of_traces(triangle, L - Q * (Q.transpose() * L));
  return u;
}

DrawnVolume draw_volume(const Equations& equations, const Triangle& triangle,
                        const VolumePlaces& places, const Vec3& tool_point) {
  constexpr std::uint32_t kDraws = 200;
  constexpr std::uint64_t kSeed = 1;
  std::vector<Vec3> points;
  const MatrixXd L = error_rows(equations, places, tool_point, points);
  const MatrixXd Q = rigid_motions(points);
  MatrixXd z(triangle.R().cols(), kDraws);
  for (std::uint32_t draw = 0; draw < kDraws; ++draw)
    for (Index i = 0; i < z.rows(); ++i)
      z(i, draw) = normal(kSeed, {static_cast<std::uint32_t>(RandomStream::intervals), draw, 0,
                                  static_cast<std::uint32_t>(i)});
  MatrixXd e = L * triangle.R().triangularView<Eigen::Upper>().solve(z);
  e -= Q * (Q.transpose() * e);
  DrawnVolume out;
  std::vector<double> length(places.q.size());
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(length.size())));
  for (Index draw = 0; draw < e.cols(); ++draw) {
    for (std::size_t i = 0; i < length.size(); ++i)
      length[i] = e.block<3, 1>(static_cast<Index>(3 * i), draw).norm();
    std::sort(length.begin(), length.end());
    out.p95 += length[rank - 1] / kDraws;
    out.max += length.back() / kDraws;
  }
  return out;
}

std::vector<double> rigid_uncertainty_at(const Equations& equations, const Triangle& triangle,
                                         const std::vector<Pose>& fitted,
                                         const std::vector<Pose>& places, const Vec3& tool_point) {
  std::vector<Vec3> points;
  const MatrixXd all = error_rows(equations, fitted, tool_point, points);
  std::vector<Vec3> shown;
  const MatrixXd L = error_rows(equations, places, tool_point, shown);
  const Pivot pivot = pivot_of(points);
  const MatrixXd motion = motions_at(pivot, points).completeOrthogonalDecomposition().solve(all);
  return roots_of_traces(triangle, L - motions_at(pivot, shown) * motion);
}

PlanChoice choose_setups(const Problem& problem, const std::vector<Pose>& places,
                         const Vec3& tool_point, std::size_t count) {
  constexpr double kSame = 1e-9;
  KnownBefore known;
  known.weak = true;
  PlanChoice choice;
  Problem taken = problem;
  taken.setups.clear();
  std::vector<bool> used(problem.setups.size(), false);
  for (std::size_t n = 0; n < std::min(count, problem.setups.size()); ++n) {
    std::size_t best = problem.setups.size();
    double least = 0.0;
    for (std::size_t k = 0; k < problem.setups.size(); ++k) {
      if (used[k]) continue;
      Problem candidate = taken;
      candidate.setups.push_back(problem.setups[k]);
      const Equations equations(candidate, true);
      const Triangle triangle = triangle_at(equations, equations.start(), known);
      const double u = volume_uncertainty(equations, triangle, places, tool_point).rms_rigid();
      if (best < problem.setups.size() && !(u < least * (1.0 - kSame))) continue;
      best = k;
      least = u;
    }
    used[best] = true;
    taken.setups.push_back(problem.setups[best]);
    choice.chosen.push_back(best);
    choice.rms_u.push_back(least);
  }
  return choice;
}

}  // namespace volcomp::host::identify
