#pragma once
// The error map of a face-gear flank: deviations over the measuring grid, positive for excess
// material, in the unit of the input. Cells may be missing. See docs/papers/face-gear.md.
//
// Rows and columns count from 0 here, from 1 in the paper's tables and in what a user reads.

#include <array>
#include <cstddef>
#include <limits>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/metrology/faces/measuring_grid.hpp"

namespace volcomp {

class ErrorMap {
 public:
  static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

  ErrorMap() { cells_.fill(kMissing); }

  // Row by row; NaN: not measured. Refused: length_mismatch (count), not_finite (index) for an
  // infinite value.
  static Status from(Span<const double> cells, ErrorMap& out);

  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return cells_[grid_index(row, column)];
  }
  void set(std::size_t row, std::size_t column, double deviation) {
    cells_[grid_index(row, column)] = deviation;
  }
  [[nodiscard]] bool has(std::size_t row, std::size_t column) const;
  [[nodiscard]] std::size_t missing() const;
  [[nodiscard]] Span<const double> cells() const { return cells_; }

  void subtract(double value);

 private:
  std::array<double, kGridCells> cells_{};
};

// First and last of the rows or columns that count, both included.
struct GridRange {
  std::size_t first = 0;
  std::size_t last = 0;
};
inline constexpr GridRange kAllRows{0, kGridRows - 1};
inline constexpr GridRange kAllColumns{0, kGridColumns - 1};
// Rows 2…6: those the paper's 5.8 µm stands for. With all seven the same column has 8.0.
inline constexpr GridRange kProfileRows{1, 5};

struct CellStatistics {
  std::size_t count = 0;  // cells that are there; all figures are 0 if there is none
  double mean = 0.0;
  double rms = 0.0;  // about zero
  double low = 0.0;
  double high = 0.0;
  double largest = 0.0;  // magnitude
  std::size_t row = 0;   // of the largest magnitude, the first if equal
  std::size_t column = 0;

  [[nodiscard]] double range() const { return high - low; }
};

// `rows` and `columns` within the grid.
[[nodiscard]] CellStatistics statistics_of(const ErrorMap& map, GridRange rows = kAllRows,
                                           GridRange columns = kAllColumns);

// Subtracts the value of the centre (row 4, column 8): for a flank without relief the same as
// turning the gear until the centre fits. Its noise goes into every other cell: rms 0.67 instead
// of 0.50. `removed`: what was subtracted. Refused: centre_missing.
Status zero_at_centre(ErrorMap& map, double& removed);

// Subtracts the mean of the cells that are there. Refused: too_few_points if there is none.
Status zero_by_mean(ErrorMap& map, double& removed);

// The deviation of the profile: the largest range of a column over `rows`.
struct ProfileDeviation {
  double value = 0.0;
  std::size_t column = 0;  // where, the first if equal
};

// Refused: bad_setting 'rows' unless first ≤ last < kGridRows, incomplete (count, index of the
// first) where a cell of these rows is missing: what was not measured cannot be graded.
Status profile_deviation(const ErrorMap& map, GridRange rows, ProfileDeviation& out);

}  // namespace volcomp
