#pragma once
// Clamped cubic B-splines to interpolate N values with: parameters, knots, and the functions that
// are not zero at a place.
//
// Places run from 0 to 1. The knots inside are means of three parameters, U_(j+3) = (t_j + t_(j+1)
// + t_(j+2))/3, so that every function has a node of its own and the collocation matrix has an
// inverse (Schoenberg and Whitney).

#include <algorithm>
#include <array>
#include <cstddef>

namespace volcomp::face_gear {

// The four cubics that are not zero at a place, and their derivatives.
struct BasisValues {
  std::size_t first = 0;  // index of the first of them
  std::array<double, 4> value{};
  std::array<double, 4> slope{};
  std::array<double, 4> curvature{};
};

template <std::size_t N>
class SplineBasis {
 public:
  static_assert(N >= 5, "knots between the ends are means of three parameters");
  static constexpr std::size_t kKnots = N + 4;

  SplineBasis() {
    std::array<double, N> t{};
    for (std::size_t k = 0; k < N; ++k)
      t[k] = static_cast<double>(k) / static_cast<double>(N - 1);
    *this = SplineBasis(t);
  }

  // `parameters`: strictly increasing from 0 to 1.
  explicit SplineBasis(const std::array<double, N>& parameters) : parameter_(parameters) {
    std::fill(knot_.end() - 4, knot_.end(), 1.0);
    for (std::size_t j = 1; j + 3 < N; ++j)
      knot_[j + 3] = (parameters[j] + parameters[j + 1] + parameters[j + 2]) / 3.0;
  }

  [[nodiscard]] const std::array<double, N>& parameters() const { return parameter_; }
  [[nodiscard]] const std::array<double, kKnots>& knots() const { return knot_; }

  // `t` within 0…1. Fixed number of operations, a search among N − 3 spans apart.
  [[nodiscard]] BasisValues at(double t) const {
    const std::size_t s = span_of(t);
    // Functions of degree 0, 1, 2 and 3 over the span; index 0 is the one that began first.
    std::array<std::array<double, 4>, 4> degree{};
    degree[0][0] = 1.0;
    for (std::size_t p = 1; p <= 3; ++p)
      raise(degree[p - 1], degree[p], s, p, t);
    BasisValues b;
    b.first = s - 3;
    b.value = degree[3];
    b.slope = derivative(degree[2], s, 3);
    b.curvature = derivative(derivative(degree[1], s, 2), s, 3);
    return b;
  }

 private:
  // The last span is closed at 1.
  [[nodiscard]] std::size_t span_of(double t) const {
    std::size_t s = 3;
    while (s + 1 < N && t >= knot_[s + 1])
      ++s;
    return s;
  }

  // From degree p − 1 to p (Cox, de Boor).
  void raise(const std::array<double, 4>& low, std::array<double, 4>& high, std::size_t s,
             std::size_t p, double t) const {
    for (std::size_t i = 0; i < p; ++i) {
      const double left = knot_[s - p + 1 + i];
      const double right = knot_[s + 1 + i];
      const double share = low[i] / (right - left);
      high[i] += (right - t) * share;
      high[i + 1] += (t - left) * share;
    }
  }

  // Derivatives of functions of degree p from the values one degree lower.
  [[nodiscard]] std::array<double, 4> derivative(const std::array<double, 4>& low, std::size_t s,
                                                 std::size_t p) const {
    std::array<double, 4> d{};
    for (std::size_t i = 0; i < p; ++i) {
      const double share =
          static_cast<double>(p) * low[i] / (knot_[s + 1 + i] - knot_[s - p + 1 + i]);
      d[i] -= share;
      d[i + 1] += share;
    }
    return d;
  }

  std::array<double, N> parameter_{};
  std::array<double, kKnots> knot_{};
};

}  // namespace volcomp::face_gear
