#include "comp/metrology/fits/lobing_fit.hpp"

#include <cmath>

namespace volcomp {
namespace {

constexpr double kDependent = 1e-9;  // what is left of the square of a term that others explain
constexpr double kUnit = 1e-6;

// N c = b, factored as L Lᵀ term by term in their order; a term without a pivot has none.
class NormalEquations {
 public:
  void add(const LobingTerms& terms, double value) {
    for (std::size_t i = 0; i < kLobingTerms; ++i) {
      for (std::size_t k = 0; k <= i; ++k)
        matrix_[i][k] += terms[i] * terms[k];
      right_[i] += terms[i] * value;
    }
  }

  // Overwrites the matrix. Returns the terms that have a pivot, a bit each.
  std::uint32_t solve(LobingTerms& coefficient) {
    std::uint32_t known = 0;
    for (std::size_t i = 0; i < kLobingTerms; ++i) {
      const double square = matrix_[i][i];
      for (std::size_t k = 0; k <= i; ++k)
        eliminate(i, k, known);
      if (matrix_[i][i] <= kDependent * square) continue;
      known |= 1U << i;
      matrix_[i][i] = std::sqrt(matrix_[i][i]);
    }
    coefficient = substituted(known, right_);
    return known;
  }

  // Diagonal of the inverse, after solve().
  [[nodiscard]] LobingTerms inverse_diagonal(std::uint32_t known) const {
    LobingTerms diagonal{};
    for (std::size_t i = 0; i < kLobingTerms; ++i) {
      LobingTerms unit{};
      unit[i] = 1.0;
      if (has(known, i)) diagonal[i] = substituted(known, unit)[i];
    }
    return diagonal;
  }

 private:
  static bool has(std::uint32_t known, std::size_t i) { return (known >> i & 1U) != 0; }

  void eliminate(std::size_t i, std::size_t k, std::uint32_t known) {
    for (std::size_t j = 0; j < k; ++j) {
      if (has(known, j)) matrix_[i][k] -= matrix_[i][j] * matrix_[k][j];
    }
    if (k < i && has(known, k)) matrix_[i][k] /= matrix_[k][k];
  }

  [[nodiscard]] LobingTerms substituted(std::uint32_t known, const LobingTerms& right) const {
    LobingTerms y{};
    for (std::size_t i = 0; i < kLobingTerms; ++i) {
      if (!has(known, i)) continue;
      y[i] = right[i];
      for (std::size_t k = 0; k < i; ++k)
        y[i] -= matrix_[i][k] * y[k];
      y[i] /= matrix_[i][i];
    }
    LobingTerms coefficient{};
    for (std::size_t i = kLobingTerms; i > 0; --i) {
      if (!has(known, i - 1)) continue;
      double rest = y[i - 1];
      for (std::size_t k = i; k < kLobingTerms; ++k)
        rest -= matrix_[k][i - 1] * coefficient[k];
      coefficient[i - 1] = rest / matrix_[i - 1][i - 1];
    }
    return coefficient;
  }

  std::array<LobingTerms, kLobingTerms> matrix_{};  // lower half
  LobingTerms right_{};
};

Status check(Span<const Vec3> direction, Span<const double> radius) {
  if (direction.size() != radius.size()) return refuse(Reason::length_mismatch);
  Where where;
  where.count = 0;
  if (direction.empty()) return refuse(Reason::too_few_points, where);
  for (std::size_t i = 0; i < direction.size(); ++i) {
    Where at;
    at.index = static_cast<int>(i);
    if (!direction[i].allFinite() || !std::isfinite(radius[i]))
      return refuse(Reason::not_finite, at);
    at.field = "direction";
    if (std::abs(direction[i].squaredNorm() - 1.0) > kUnit) return refuse(Reason::bad_setting, at);
  }
  return {};
}

int bits(std::uint32_t mask) {
  int n = 0;
  for (std::size_t i = 0; i < kLobingTerms; ++i)
    n += static_cast<int>(mask >> i & 1U);
  return n;
}

}  // namespace

Status fit_lobing(Span<const Vec3> direction, Span<const double> radius, LobingFit& out) {
  if (const Status s = check(direction, radius); !s.ok()) return s;
  const double about = radius[0];  // close to all of them: nothing is lost in the squares
  NormalEquations equations;
  for (std::size_t i = 0; i < direction.size(); ++i)
    equations.add(lobing_terms(direction[i]), radius[i] - about);
  LobingFit fit;
  fit.known = equations.solve(fit.map.coefficient);
  fit.rank = bits(fit.known);
  fit.cofactor = equations.inverse_diagonal(fit.known);
  fit.map.coefficient[0] += about;
  double sum = 0.0;
  for (std::size_t i = 0; i < direction.size(); ++i) {
    const double residual = radius[i] - fit.map.radius(direction[i]);
    sum += residual * residual;
    if (std::abs(residual) <= std::abs(fit.largest)) continue;
    fit.largest = residual;
    fit.worst = i;
  }
  const auto rank = static_cast<std::size_t>(fit.rank);
  const std::size_t freedom = direction.size() > rank ? direction.size() - rank : 1;
  fit.rms = std::sqrt(sum / static_cast<double>(freedom));
  out = fit;
  return {};
}

}  // namespace volcomp
