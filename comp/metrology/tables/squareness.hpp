#pragma once
// Squareness closure (docs/papers/xyfz.md, "What we do"): what a ball bar measured minus what the
// straightness and angle tables already contain at the same place. Exact in one step; absorbs any
// slope convention and any constant angle.

#include "comp/core/span.hpp"
#include "comp/machine/xyfz.hpp"
#include "comp/metrology/tables/error_table.hpp"
#include "comp/metrology/tables/line_fit.hpp"

namespace volcomp {

// The place of a squareness measurement: three lines through one point.
struct SquarenessLines {
  Vec3 fixed_point = Vec3::Zero();
  Span<const double> x;  // positions along each line, at least two different ones
  Span<const double> y;
  Span<const double> z;
};

// The squareness a model shows along the lines. `error_at(Vec3 q)` returns the volumetric error
// (mm); positions per line at most kTableKnots.
template <class ErrorAt>
[[nodiscard]] XyfzSquareness apparent_squareness(const ErrorAt& error_at,
                                                 const SquarenessLines& lines) {
  const auto slope = [&](Eigen::Index component, Eigen::Index along) {
    const Span<const double> x = along == 0 ? lines.x : (along == 1 ? lines.y : lines.z);
    std::array<double, kTableKnots> y{};
    const std::size_t n = x.size() < y.size() ? x.size() : y.size();
    for (std::size_t i = 0; i < n; ++i) {
      Vec3 q = lines.fixed_point;
      q(along) = x[i];
      y[i] = error_at(q)(component);
    }
    return least_squares_slope({x.data(), n}, {y.data(), n});
  };
  return {slope(1, 0) + slope(0, 1), slope(2, 0) + slope(0, 2), -slope(2, 1) - slope(1, 2)};
}

// Parameters to put into the model.
[[nodiscard]] constexpr XyfzSquareness close_squareness(const XyfzSquareness& measured,
                                                        const XyfzSquareness& apparent) {
  return {measured.a_xy - apparent.a_xy, measured.a_xz - apparent.a_xz,
          measured.a_yz - apparent.a_yz};
}

}  // namespace volcomp
