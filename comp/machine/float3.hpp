#pragma once
// Small vectors of the tick, one component per axis, in registers wherever indices are constant.

#include <array>
#include <cstddef>

#include "comp/core/inline.hpp"
#include "comp/machine/joint.hpp"

namespace volcomp {

using Float3 = std::array<float, 3>;

namespace kernel {

VOLCOMP_INLINE void add(Float3& a, const Float3& b) {
  a[0] += b[0];
  a[1] += b[1];
  a[2] += b[2];
}

VOLCOMP_INLINE void subtract(Float3& a, const Float3& b) {
  a[0] -= b[0];
  a[1] -= b[1];
  a[2] -= b[2];
}

// e += x · (w × unit vector of `axis`)
VOLCOMP_INLINE void add_cross_axis(Float3& e, const Float3& w, Axis axis, float x) {
  switch (axis) {
    case Axis::x:
      e[1] += w[2] * x;
      e[2] -= w[1] * x;
      break;
    case Axis::y:
      e[0] -= w[2] * x;
      e[2] += w[0] * x;
      break;
    case Axis::z:
      e[0] += w[1] * x;
      e[1] -= w[0] * x;
      break;
  }
}

// e += x · (w × n)
VOLCOMP_INLINE void add_cross(Float3& e, const Float3& w, const Float3& n, float x) {
  e[0] += (w[1] * n[2] - w[2] * n[1]) * x;
  e[1] += (w[2] * n[0] - w[0] * n[2]) * x;
  e[2] += (w[0] * n[1] - w[1] * n[0]) * x;
}

// In the plane J, K: by the angle of sine s and cosine c from J to K.
template <std::size_t J, std::size_t K>
VOLCOMP_INLINE void rotate_plane(Float3& p, float s, float c) {
  const float j = p[J];
  const float k = p[K];
  p[J] = c * j - s * k;
  p[K] = s * j + c * k;
}

VOLCOMP_INLINE void rotate(Float3& p, Axis axis, float s, float c) {
  switch (axis) {
    case Axis::x:
      rotate_plane<1, 2>(p, s, c);
      break;
    case Axis::y:
      rotate_plane<2, 0>(p, s, c);
      break;
    case Axis::z:
      rotate_plane<0, 1>(p, s, c);
      break;
  }
}

VOLCOMP_INLINE void orient(Float3& p, const std::array<float, 9>& R) {
  p = {R[0] * p[0] + R[1] * p[1] + R[2] * p[2], R[3] * p[0] + R[4] * p[1] + R[5] * p[2],
       R[6] * p[0] + R[7] * p[1] + R[8] * p[2]};
}

VOLCOMP_INLINE void orient_inverse(Float3& p, const std::array<float, 9>& R) {
  p = {R[0] * p[0] + R[3] * p[1] + R[6] * p[2], R[1] * p[0] + R[4] * p[1] + R[7] * p[2],
       R[2] * p[0] + R[5] * p[1] + R[8] * p[2]};
}

VOLCOMP_INLINE float dot(const Float3& a, const Float3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

VOLCOMP_INLINE Float3 cross(const Float3& a, const Float3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace kernel
}  // namespace volcomp
