#pragma once
// From the error of a tick to offsets of the correcting axes: Δq = −J⁺ E in nm (linear) or rad
// (rotary).

#include "comp/realtime/error_kernel.hpp"

namespace volcomp::kernel {

using Offsets = std::array<float, kMaxCorrecting>;

VOLCOMP_INLINE float dot(const Float3& a, const Float3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

VOLCOMP_INLINE Float3 cross(const Float3& a, const Float3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Linear correcting axes: constant inverse, a signed selection where the axes lie along X, Y, Z.
template <class Machine, class Set>
VOLCOMP_INLINE Offsets constant_offsets(const Machine& machine, const Set& set, const Float3& e) {
  Offsets out{};
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c) {
    if (machine.chain.inverse.valid) {
      out[c] = -machine.chain.inverse.gain[c] * e[machine.chain.inverse.component[c]];
    } else {
      out[c] = dot(set.inverse[c], e);
    }
  }
  return out;
}

// Squared authority must reach (0.1)² (conventions, section 4); squared lengths avoid a square
// root.
inline constexpr float kMinAuthoritySquared = 0.01F;

// Three correcting axes: Cramer's rule. False without authority; `out` is then 0.
VOLCOMP_INLINE bool solve_three(const std::array<Float3, 3>& column, const Float3& e,
                                Offsets& out) {
  const Float3 yz = cross(column[1], column[2]);
  const float det = dot(column[0], yz);
  const float scale =
      dot(column[0], column[0]) * dot(column[1], column[1]) * dot(column[2], column[2]);
  if (!(det * det >= kMinAuthoritySquared * scale) || !(scale > 0.0F)) return false;
  const float k = -1.0F / det;
  out = {k * dot(e, yz), k * dot(e, cross(column[2], column[0])),
         k * dot(e, cross(column[0], column[1]))};
  return true;
}

// Two: least squares by the normal equations. One: projection.
VOLCOMP_INLINE bool solve_two(const Float3& a, const Float3& b, const Float3& e, Offsets& out) {
  const float aa = dot(a, a);
  const float bb = dot(b, b);
  const float ab = dot(a, b);
  const float det = aa * bb - ab * ab;
  if (!(det >= kMinAuthoritySquared * aa * bb) || !(det > 0.0F)) return false;
  const float ae = dot(a, e);
  const float be = dot(b, e);
  out = {(ab * be - bb * ae) / det, (ab * ae - aa * be) / det, 0.0F};
  return true;
}

VOLCOMP_INLINE bool solve_one(const Float3& a, const Float3& e, Offsets& out) {
  const float aa = dot(a, a);
  if (!(aa > 0.0F)) return false;
  out = {-dot(a, e) / aa, 0.0F, 0.0F};
  return true;
}

VOLCOMP_INLINE bool varying_offsets(std::size_t correcting, const Deviation& d, Offsets& out) {
  out = {};
  if (correcting == 3) return solve_three(d.column, d.error, out);
  if (correcting == 2) return solve_two(d.column[0], d.column[1], d.error, out);
  return correcting == 1 && solve_one(d.column[0], d.error, out);
}

}  // namespace volcomp::kernel
