#pragma once
// Body and face diagonals after ISO 230-6: e_d(s) = d · (E(p(s)) − E(p(0))), d the unit vector from
// start to end (docs/papers/xyfz.md). The sign does not depend on the direction of travel.

#include <algorithm>
#include <array>
#include <cmath>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/machine/frame.hpp"

namespace volcomp {

struct DiagonalBox {
  Vec3 lo;
  Vec3 hi;
};

struct Diagonal {
  const char* name = "";
  Vec3 start = Vec3::Zero();
  Vec3 end = Vec3::Zero();

  [[nodiscard]] Vec3 at(double s) const { return start + s * (end - start); }
  [[nodiscard]] double length() const { return (end - start).norm(); }
  [[nodiscard]] Vec3 direction() const { return (end - start) / length(); }
};

struct DiagonalFigures {
  double max_abs = 0.0;
  double range = 0.0;  // max − min
};

// PPP, NPP, PNP, PPN: sign P of an axis runs lo → hi, N hi → lo.
[[nodiscard]] std::array<Diagonal, 4> body_diagonals(const DiagonalBox& box);

// XY+, XY−, XZ+, XZ−, YZ+, YZ− (second axis reversed for −), the third axis at the middle of the
// box.
[[nodiscard]] std::array<Diagonal, 6> face_diagonals(const DiagonalBox& box);

// 100 (before − after) / before.
[[nodiscard]] constexpr double improvement_percent(double before, double after) {
  return 100.0 * (before - after) / before;
}

[[nodiscard]] DiagonalFigures diagonal_figures(Span<const double> deviations);

// Deviations at the n = deviations.size() ≥ 2 equally spaced points of a diagonal, in the unit of
// `error_at(Vec3 q)`.
template <class ErrorAt>
Status diagonal_deviations(const ErrorAt& error_at, const Diagonal& diagonal,
                           Span<double> deviations, DiagonalFigures& figures) {
  if (deviations.size() < 2 || !(diagonal.length() > 0.0)) return refuse(Reason::too_few_points);
  const Vec3 d = diagonal.direction();
  const Vec3 first = error_at(diagonal.start);
  for (std::size_t j = 0; j < deviations.size(); ++j) {
    const double s = static_cast<double>(j) / static_cast<double>(deviations.size() - 1);
    deviations[j] = d.dot(error_at(diagonal.at(s)) - first);
  }
  figures = diagonal_figures({deviations.data(), deviations.size()});
  return {};
}

}  // namespace volcomp
