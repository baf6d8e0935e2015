#include "host_sim/host/measure/identify/error_function.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp::host::identify {
namespace {

constexpr std::size_t kDegree = 3;
constexpr std::size_t kSteps = 20;  // between the samples of a travel

std::array<double, 4> periodic_cubic(double t) {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, ((3.0 * t - 6.0) * t * t + 4.0) / 6.0,
          (((-3.0 * t + 3.0) * t + 3.0) * t + 1.0) / 6.0, t * t * t / 6.0};
}

// Recursion of Cox and de Boor over the knots 0 0 0 0 1 … n n n n, for the four functions of a
// segment.
std::array<double, 4> clamped_cubic(std::size_t segment, std::size_t segments, double u) {
  const auto knot = [&](std::size_t i) {
    const double k = static_cast<double>(i) - static_cast<double>(kDegree);
    return std::clamp(k, 0.0, static_cast<double>(segments));
  };
  const std::size_t span = segment + kDegree;
  std::array<double, 4> N{1.0, 0.0, 0.0, 0.0};
  for (std::size_t p = 1; p <= kDegree; ++p) {
    double carried = 0.0;
    for (std::size_t j = 0; j < p; ++j) {
      const double right = knot(span + 1 + j) - u;
      const double left = u - knot(span + 1 + j - p);
      const double part = N.at(j) / (right + left);
      N.at(j) = carried + right * part;
      carried = left * part;
    }
    N.at(p) = carried;
  }
  return N;
}

}  // namespace

BasisPieces FunctionBasis::pieces(std::size_t segment, double u) const {
  const std::array<double, 4> N = periodic_ ? periodic_cubic(u - static_cast<double>(segment))
                                            : clamped_cubic(segment, segments_, u);
  BasisPieces out;
  for (std::size_t m = 0; m < out.size(); ++m)
    out.at(m) = {periodic_ ? (segment + m) % segments_ : segment + m, N.at(m)};
  return out;
}

BasisPieces FunctionBasis::at(double q) const {
  const auto n = static_cast<double>(segments_);
  double u = (q - lo_) / (hi_ - lo_) * n;
  if (periodic_) u -= n * std::floor(u / n);
  const double segment = std::clamp(std::floor(u), 0.0, n - 1.0);
  return pieces(static_cast<std::size_t>(segment), u);
}

// Of a cubic exactly: the difference of the values at the ends and twice that in the middle, over a
// quarter.
BasisPieces FunctionBasis::curvature(std::size_t segment) const {
  const auto u = static_cast<double>(segment);
  const BasisPieces begin = pieces(segment, u);
  const BasisPieces middle = pieces(segment, u + 0.5);
  const BasisPieces end = pieces(segment, u + 1.0);
  BasisPieces out = middle;
  for (std::size_t m = 0; m < out.size(); ++m)
    out.at(m).value = 4.0 * (begin.at(m).value - 2.0 * middle.at(m).value + end.at(m).value);
  return out;
}

std::vector<double> FunctionBasis::samples() const {
  std::vector<double> q;
  for (std::size_t k = 0; k < (periodic_ ? kSteps : kSteps + 1); ++k)
    q.push_back(lo_ + static_cast<double>(k) * (hi_ - lo_) / static_cast<double>(kSteps));
  return q;
}

std::vector<double> FunctionBasis::slope_weights() const {
  std::vector<double> weight = samples();
  double mean = 0.0;
  for (const double q : weight)
    mean += q / static_cast<double>(weight.size());
  double squares = 0.0;
  for (double& q : weight) {
    q -= mean;
    squares += q * q;
  }
  for (double& q : weight)
    q /= squares;
  return weight;
}

}  // namespace volcomp::host::identify
