#pragma once
// A smooth surface through an error map: least-squares polynomial in row and column
// (docs/papers/face-gear.md, eq. 31).

#include <array>
#include <cstddef>

#include "comp/metrology/faces/error_map.hpp"

namespace volcomp::test {

inline constexpr int kMaxMapDegree = 4;
inline constexpr std::size_t kMaxMapTerms = 15;  // x^i y^j with i + j ≤ kMaxMapDegree

// Coordinates are scaled so that powers of them stay apart: −1 at the first row or column, +1 at
// the last.
[[nodiscard]] constexpr double scaled_row(double row) {
  return 2.0 * row / static_cast<double>(kGridRows - 1) - 1.0;
}
[[nodiscard]] constexpr double scaled_column(double column) {
  return 2.0 * column / static_cast<double>(kGridColumns - 1) - 1.0;
}

struct MapPolynomial {
  int degree = 0;
  // Factors of 1, x, y, x², xy, y², x³ … with x the scaled row and y the scaled column; unit of the
  // map.
  std::array<double, kMaxMapTerms> coefficient{};
  double rms = 0.0;  // of what is left, over all cells that are there

  [[nodiscard]] double at(double x, double y) const;
};

// Unweighted, over the cells that are there; terms up to total degree 0…kMaxMapDegree. Refused:
// bad_setting 'degree', surface_not_determined (count of cells) where cells are too few or lie so
// that they do not determine it.
Status fit_map(const ErrorMap& map, int degree, MapPolynomial& out);

}  // namespace volcomp::test
