#include "comp/metrology/faces/map_comparison.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "comp/metrology/fits/pseudo_inverse.hpp"

namespace volcomp {
namespace {

constexpr int kUnknowns = 6 + static_cast<int>(kMaxComparedFlanks);
constexpr double kVoid = 1e-10;  // eigenvalues of the normal matrix below this share are rounding

using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

// One cell of one flank.
struct Cell {
  std::size_t flank;
  std::size_t row;
  std::size_t column;
  const SurfacePoint& nominal;
  double value;
};

template <class Visit>
void each_cell(Span<const ComparedFlank> flanks, const Visit& visit) {
  for (std::size_t f = 0; f < flanks.size(); ++f) {
    for (std::size_t row = 0; row < kGridRows; ++row) {
      for (std::size_t column = 0; column < kGridColumns; ++column) {
        const ErrorMap& map = *flanks[f].difference;
        if (!map.has(row, column)) continue;
        const SurfacePoint& nominal = flanks[f].nominal[grid_index(row, column)];
        visit(Cell{f, row, column, nominal, map.at(row, column)});
      }
    }
  }
}

Status check(Span<const ComparedFlank> flanks) {
  Where where;
  where.count = static_cast<int>(flanks.size());
  if (flanks.empty()) return refuse(Reason::too_few_points, where);
  if (flanks.size() > kMaxComparedFlanks) return refuse(Reason::length_mismatch, where);
  for (std::size_t f = 0; f < flanks.size(); ++f) {
    Where at;
    at.index = static_cast<int>(f);
    if (flanks[f].difference == nullptr || flanks[f].nominal.size() != kGridCells)
      return refuse(Reason::length_mismatch, at);
    for (std::size_t i = 0; i < kGridCells; ++i) {
      const SurfacePoint& p = flanks[f].nominal[i];
      at.index = static_cast<int>(i);
      if (!p.point.allFinite() || !p.normal.allFinite()) return refuse(Reason::not_finite, at);
    }
  }
  return {};
}

// Rotations in units of length at the mean radius, so that all unknowns weigh alike.
class FrameModel {
 public:
  FrameModel(Span<const ComparedFlank> flanks, const FrameMotions& freedom) : freedom_(freedom) {
    double sum = 0.0;
    double count = 0.0;
    each_cell(flanks, [&](const Cell& cell) {
      sum += cell.nominal.point.norm();
      count += 1.0;
    });
    if (sum > 0.0) radius_ = sum / count;
  }

  [[nodiscard]] Unknowns row(const Cell& cell) const {
    const Vec3 turning = cell.nominal.point.cross(cell.nominal.normal) / radius_;
    Unknowns row = Unknowns::Zero();
    row.head<3>() = cell.nominal.normal;
    row.segment<3>(3) = turning;
    for (std::size_t i = 0; i < 6; ++i) {
      if (!freedom_.motion[i]) row(static_cast<Eigen::Index>(i)) = 0.0;
    }
    if (freedom_.constants) row(6 + static_cast<Eigen::Index>(cell.flank)) = 1.0;
    return row;
  }
  [[nodiscard]] double radius() const { return radius_; }

 private:
  FrameMotions freedom_;
  double radius_ = 1.0;
};

int unknowns_of(const FrameMotions& freedom, std::size_t flanks) {
  int count = freedom.constants ? static_cast<int>(flanks) : 0;
  for (const bool free : freedom.motion)
    count += free ? 1 : 0;
  return count;
}

}  // namespace

Status compare_maps(const ErrorMap& first, const ErrorMap& second, MapDifference& out) {
  MapDifference d;
  for (std::size_t row = 0; row < kGridRows; ++row) {
    for (std::size_t column = 0; column < kGridColumns; ++column)
      d.difference.set(row, column, first.at(row, column) - second.at(row, column));
  }
  d.overall = statistics_of(d.difference);
  Where where;
  where.count = static_cast<int>(d.overall.count);
  if (d.overall.count == 0) return refuse(Reason::too_few_points, where);
  for (std::size_t row = 0; row < kGridRows; ++row)
    d.row[row] = statistics_of(d.difference, {row, row}, kAllColumns);
  for (std::size_t column = 0; column < kGridColumns; ++column)
    d.column[column] = statistics_of(d.difference, kAllRows, {column, column});
  out = d;
  return {};
}

Status frame_share(Span<const ComparedFlank> flanks, const FrameMotions& freedom, FrameShare& out) {
  if (const Status s = check(flanks); !s.ok()) return s;
  const FrameModel model(flanks, freedom);
  Normal normal = Normal::Zero();
  Unknowns right = Unknowns::Zero();
  double before = 0.0;
  int cells = 0;
  each_cell(flanks, [&](const Cell& cell) {
    const Unknowns row = model.row(cell);
    normal += row * row.transpose();
    right += cell.value * row;
    before += cell.value * cell.value;
    ++cells;
  });
  Where where;
  where.count = cells;
  if (cells == 0 || cells < unknowns_of(freedom, flanks.size()))
    return refuse(Reason::too_few_points, where);

  const LeastSquares<kUnknowns> solution = pseudo_solve<kUnknowns>(normal, right, kVoid);
  FrameShare share;
  double after = 0.0;
  each_cell(flanks, [&](const Cell& cell) {
    const double rest = cell.value - model.row(cell).dot(solution.x);
    share.rest[cell.flank].set(cell.row, cell.column, rest);
    after += rest * rest;
  });
  share.shift = solution.x.head<3>();
  share.turn = solution.x.segment<3>(3) / model.radius();
  for (std::size_t f = 0; f < kMaxComparedFlanks; ++f)
    share.constant[f] = solution.x(6 + static_cast<Eigen::Index>(f));
  share.rms_before = std::sqrt(before / cells);
  share.rms_after = std::sqrt(after / cells);
  share.explained = before > 0.0 ? 1.0 - after / before : 0.0;
  share.rank = solution.rank;
  out = share;
  return {};
}

}  // namespace volcomp
