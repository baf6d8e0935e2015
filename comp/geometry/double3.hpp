#pragma once
// Turning vectors in double, written out: the order of operations is this one with every compiler,
// and a processor that computes doubles in software has them once in its image and not, unrolled,
// wherever they are used.

#include <cmath>

#include "comp/geometry/error_motion.hpp"

// Where doubles are in hardware, VOLCOMP_IN_ONE makes one function of all that is called, for most
// of what the calls cost is saving registers, and loops of 16 are unrolled. Elsewhere
// VOLCOMP_SHARED keeps what it marks out of line.
#if defined(__arm__) && (__ARM_FP & 8) == 0
#define VOLCOMP_IN_ONE
#define VOLCOMP_SHARED [[gnu::noinline]]
#define VOLCOMP_UNROLL_16
#else
#define VOLCOMP_IN_ONE [[gnu::flatten]]
#define VOLCOMP_SHARED
#if defined(__clang__)
#define VOLCOMP_UNROLL_16 _Pragma("unroll")
#else
#define VOLCOMP_UNROLL_16 _Pragma("GCC unroll 16")
#endif
#endif

namespace volcomp {

// R v
VOLCOMP_SHARED inline Vec3 turned(const Mat3& R, const Vec3& v) {
  return {R(0, 0) * v[0] + R(0, 1) * v[1] + R(0, 2) * v[2],
          R(1, 0) * v[0] + R(1, 1) * v[1] + R(1, 2) * v[2],
          R(2, 0) * v[0] + R(2, 1) * v[1] + R(2, 2) * v[2]};
}

// Rᵀ v
VOLCOMP_SHARED inline Vec3 turned_back(const Mat3& R, const Vec3& v) {
  return {R(0, 0) * v[0] + R(1, 0) * v[1] + R(2, 0) * v[2],
          R(0, 1) * v[0] + R(1, 1) * v[1] + R(2, 1) * v[2],
          R(0, 2) * v[0] + R(1, 2) * v[1] + R(2, 2) * v[2]};
}

// A B
VOLCOMP_SHARED inline Mat3 product(const Mat3& A, const Mat3& B) {
  Mat3 out;
  out.col(0) = turned(A, B.col(0));
  out.col(1) = turned(A, B.col(1));
  out.col(2) = turned(A, B.col(2));
  return out;
}

// v + s w
VOLCOMP_SHARED inline Vec3 added(const Vec3& v, double s, const Vec3& w) {
  return {v[0] + s * w[0], v[1] + s * w[1], v[2] + s * w[2]};
}

// |v| to 1e-14, 0 below 1e-22, NaN of NaN: a step of Heron's method from the square root of a
// float.
VOLCOMP_SHARED inline double length(const Vec3& v) {
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  const auto root = static_cast<double>(std::sqrt(static_cast<float>(square)));
  return root > 0.0 ? 0.5 * (root + square / root) : root;
}

}  // namespace volcomp
