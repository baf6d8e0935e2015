#pragma once
// From the error of a tick to the excess of the correcting axes, J⁺ E in nm (linear) or 2^-32 turn
// (rotary); the motion offset is its negative (conventions, section 4).

#include "comp/tick/folded_error.hpp"
#include "comp/tick/recursive_error.hpp"

namespace volcomp::kernel {

using Excess = std::array<float, kMaxCorrecting>;

// Three correcting axes that lie along X, Y and Z.
VOLCOMP_INLINE Excess aligned_excess(const InversePlan& plan, const Float3& e) {
  Excess out{};
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c)
    out[c] = plan.gain[c] * e[plan.component[c]];
  return out;
}

// Linear correcting axes: the rows of J⁻¹ come with the tables.
template <class Set>
VOLCOMP_INLINE Excess constant_excess(const Set& set, const Float3& e) {
  Excess out{};
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c)
    out[c] = dot(set.inverse[c], e);
  return out;
}

// Squared authority must reach (0.1)² (conventions, section 4); squared lengths avoid a square
// root.
inline constexpr float kMinAuthoritySquared = 0.01F;

// Three correcting axes: Cramer's rule. False without authority.
VOLCOMP_INLINE bool solve_three(const std::array<Float3, 3>& column, const Float3& e, Excess& out) {
  const Float3 yz = cross(column[1], column[2]);
  const float det = dot(column[0], yz);
  const float scale =
      dot(column[0], column[0]) * dot(column[1], column[1]) * dot(column[2], column[2]);
  if (!(det * det >= kMinAuthoritySquared * scale) || !(scale > 0.0F)) return false;
  const float k = 1.0F / det;
  out = {k * dot(e, yz), k * dot(e, cross(column[2], column[0])),
         k * dot(e, cross(column[0], column[1]))};
  return true;
}

// Two: least squares by the normal equations. One: projection.
VOLCOMP_INLINE bool solve_two(const Float3& a, const Float3& b, const Float3& e, Excess& out) {
  const float aa = dot(a, a);
  const float bb = dot(b, b);
  const float ab = dot(a, b);
  const float det = aa * bb - ab * ab;
  if (!(det >= kMinAuthoritySquared * aa * bb) || !(det > 0.0F)) return false;
  const float ae = dot(a, e);
  const float be = dot(b, e);
  out = {(bb * ae - ab * be) / det, (aa * be - ab * ae) / det, 0.0F};
  return true;
}

VOLCOMP_INLINE bool solve_one(const Float3& a, const Float3& e, Excess& out) {
  const float aa = dot(a, a);
  if (!(aa > 0.0F)) return false;
  out = {dot(a, e) / aa, 0.0F, 0.0F};
  return true;
}

// Two aligned axes and one with the column b: Cramer's rule with its zeros and ones left out; the
// same bits as solve_three.
VOLCOMP_INLINE bool solve_one_varying(const InversePlan& plan, const Float3& b, const Float3& e,
                                      Excess& out) {
  const std::size_t w = plan.varying_component;
  const float scale = dot(b, b);
  if (!(b[w] * b[w] >= kMinAuthoritySquared * scale) || !(scale > 0.0F)) return false;
  const float k = 1.0F / b[w];
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c) {
    const std::size_t a = plan.component[c];
    out[c] = c == plan.varying ? k * e[w] * plan.units[c]
                               : plan.gain[c] * (k * (e[a] * b[w] - e[w] * b[a]));
  }
  return true;
}

// In nm or rad, by the number of correcting axes.
template <class Machine>
VOLCOMP_INLINE bool solve(const Machine& machine, const Columns& columns, const Float3& e,
                          Excess& out) {
  const auto column = [&](std::size_t c) VOLCOMP_INLINE_LAMBDA {
    return columns[machine.chain.inverse.column[c]];
  };
  switch (machine.chain.correcting_count) {
    case 3:
      return solve_three({column(0), column(1), column(2)}, e, out);
    case 2:
      return solve_two(column(0), column(1), e, out);
    case 1:
      return solve_one(column(0), e, out);
    default:
      return false;
  }
}

// By what is constant, or by the columns of the recursion. False without authority; `out` is then
// 0.
template <class Machine, class Set>
VOLCOMP_INLINE bool find_excess(const Machine& machine, const Set& set, const Columns& columns,
                                const Float3& e, Excess& out) {
  const InversePlan& plan = machine.chain.inverse;
  if (plan.form == InverseForm::aligned) {
    out = aligned_excess(plan, e);
    return true;
  }
  if (plan.form == InverseForm::constant) {
    out = constant_excess(set, e);
    return true;
  }
  const bool one = plan.form == InverseForm::one_varying;
  if (one ? solve_one_varying(plan, columns[0], e, out) : solve(machine, columns, e, out)) {
    for (std::size_t c = 0; c < kMaxCorrecting && !one; ++c)
      out[c] *= plan.units[c];
    return true;
  }
  out = {};
  return false;
}

}  // namespace volcomp::kernel
