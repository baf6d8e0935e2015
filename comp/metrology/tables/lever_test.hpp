#pragma once
// Lever self-test, mandatory at commissioning (docs/papers/xyfz.md): positioning measured at two
// places differs by ε × ΔL. Regressing the difference on the measured angles must return the lever
// difference; a wrong sign, unit (arc seconds for µrad) or order of axes cannot pass.

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/metrology/tables/abbe.hpp"

namespace volcomp {

struct LeverTest {
  std::array<double, 2> found{};     // regression slopes, mm, for the two angles across the axis
  std::array<double, 2> expected{};  // lever differences, mm
  std::array<double, 2> allowed{};   // 5 % of |ΔL| + three standard errors
};

// Mean values per target at the two places of the same axis (same targets, at least four), and the
// sensed points. Refuses too_few_points, lever_spread_too_small (angles constant, levers
// equal, or so much noise that half of |ΔL| would be allowed), lever_mismatch (where.index = angle,
// where.value = found, where.deviation = found − expected). `out` is filled in the last case too.
Status lever_self_test(Axis axis, Span<const ErrorMotion> first, Span<const ErrorMotion> second,
                       const Vec3& first_lever, const Vec3& second_lever, LeverTest& out);

}  // namespace volcomp
