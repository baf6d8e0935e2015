#include "comp/metrology/faces/error_map.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp {

Status ErrorMap::from(Span<const double> cells, ErrorMap& out) {
  Where where;
  where.count = static_cast<int>(cells.size());
  if (cells.size() != kGridCells) return refuse(Reason::length_mismatch, where);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Where at;
    at.index = static_cast<int>(i);
    if (std::isinf(cells[i])) return refuse(Reason::not_finite, at);
  }
  std::copy(cells.begin(), cells.end(), out.cells_.begin());
  return {};
}

bool ErrorMap::has(std::size_t row, std::size_t column) const {
  return !std::isnan(at(row, column));
}

std::size_t ErrorMap::missing() const {
  std::size_t count = 0;
  for (const double cell : cells_)
    count += std::isnan(cell) ? 1U : 0U;
  return count;
}

void ErrorMap::subtract(double value) {
  for (double& cell : cells_)
    cell -= value;
}

CellStatistics statistics_of(const ErrorMap& map, GridRange rows, GridRange columns) {
  CellStatistics s;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t row = rows.first; row <= rows.last; ++row) {
    for (std::size_t column = columns.first; column <= columns.last; ++column) {
      if (!map.has(row, column)) continue;
      const double value = map.at(row, column);
      s.low = s.count == 0 ? value : std::min(s.low, value);
      s.high = s.count == 0 ? value : std::max(s.high, value);
      sum += value;
      squares += value * value;
      if (s.count == 0 || std::abs(value) > s.largest) {
        s.largest = std::abs(value);
        s.row = row;
        s.column = column;
      }
      ++s.count;
    }
  }
  if (s.count == 0) return s;
  s.mean = sum / static_cast<double>(s.count);
  s.rms = std::sqrt(squares / static_cast<double>(s.count));
  return s;
}

Status zero_at_centre(ErrorMap& map, double& removed) {
  if (!map.has(kCentreRow, kCentreColumn)) {
    Where where;
    where.index = static_cast<int>(grid_index(kCentreRow, kCentreColumn));
    return refuse(Reason::centre_missing, where);
  }
  removed = map.at(kCentreRow, kCentreColumn);
  map.subtract(removed);
  return {};
}

Status zero_by_mean(ErrorMap& map, double& removed) {
  const CellStatistics s = statistics_of(map);
  Where where;
  where.count = static_cast<int>(s.count);
  if (s.count == 0) return refuse(Reason::too_few_points, where);
  removed = s.mean;
  map.subtract(removed);
  return {};
}

Status profile_deviation(const ErrorMap& map, GridRange rows, ProfileDeviation& out) {
  if (rows.first > rows.last || rows.last >= kGridRows) {
    Where where;
    where.field = "rows";
    return refuse(Reason::bad_setting, where);
  }
  Where gap;
  int missing = 0;
  ProfileDeviation deviation;
  for (std::size_t column = 0; column < kGridColumns; ++column) {
    for (std::size_t row = rows.first; row <= rows.last; ++row) {
      if (map.has(row, column)) continue;
      const int index = static_cast<int>(grid_index(row, column));
      gap.index = missing == 0 ? index : std::min(gap.index, index);
      ++missing;
    }
    const double range = statistics_of(map, rows, {column, column}).range();
    if (range > deviation.value) deviation = {range, column};
  }
  gap.count = missing;
  if (missing > 0) return refuse(Reason::incomplete, gap);
  out = deviation;
  return {};
}

}  // namespace volcomp
