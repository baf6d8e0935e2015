#pragma once
// One error function of an axis over its travel: a cubic B-spline on equal segments, clamped at the
// ends of a travel, periodic over a full turn. Local support keeps a gap in the data local. Beyond
// the travel the polynomials at its ends go on.

#include <array>
#include <cstddef>
#include <vector>

namespace volcomp::host::identify {

// The basis functions that are not 0 at a place: coefficient and value.
struct BasisPiece {
  std::size_t coefficient = 0;
  double value = 0.0;
};
using BasisPieces = std::array<BasisPiece, 4>;

class FunctionBasis {
 public:
  // `segments`: one or more, of a full turn four or more.
  FunctionBasis(double lo, double hi, bool periodic, std::size_t segments)
      : lo_(lo), hi_(hi), periodic_(periodic), segments_(segments) {}

  // How many coefficients there are.
  [[nodiscard]] std::size_t size() const { return periodic_ ? segments_ : segments_ + 3; }
  [[nodiscard]] std::size_t segments() const { return segments_; }
  [[nodiscard]] BasisPieces at(double q) const;
  // Second derivative in the middle of a segment, times its length squared.
  [[nodiscard]] BasisPieces curvature(std::size_t segment) const;

  // Where constraints and reports look: 21 places over the travel, 20 over a full turn.
  [[nodiscard]] std::vector<double> samples() const;
  // Weight of each sample in the slope of least squares over them, a unit of q.
  [[nodiscard]] std::vector<double> slope_weights() const;

 private:
  // In a segment, its polynomials at `u` segments from the beginning of the travel.
  [[nodiscard]] BasisPieces pieces(std::size_t segment, double u) const;

  double lo_;
  double hi_;
  bool periodic_;
  std::size_t segments_;
};

}  // namespace volcomp::host::identify
