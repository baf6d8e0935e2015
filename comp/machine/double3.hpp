#pragma once
// Turning vectors in double, written out: the order of operations is this one with every compiler,
// and a processor that computes doubles in software has them once in its image and not, unrolled,
// wherever they are used.

#include <cmath>
#include <cstddef>

#include "comp/machine/error_motion.hpp"

// Where doubles are in hardware, VOLCOMP_FLATTEN makes one function of all that is called, for most
// of what the calls cost is saving registers, and loops of 16 are unrolled. Elsewhere
// VOLCOMP_SHARED keeps what it marks out of line.
#if defined(__arm__) && (__ARM_FP & 8) == 0
#define VOLCOMP_FLATTEN
#define VOLCOMP_SHARED [[gnu::noinline]]
#define VOLCOMP_UNROLL_16
#else
#define VOLCOMP_FLATTEN [[gnu::flatten]]
#define VOLCOMP_SHARED
#if defined(__clang__)
#define VOLCOMP_UNROLL_16 _Pragma("unroll")
#else
#define VOLCOMP_UNROLL_16 _Pragma("GCC unroll 16")
#endif
#endif

namespace volcomp {

// a b + c d
VOLCOMP_SHARED inline double sum_of_products(double a, double b, double c, double d) {
  return a * b + c * d;
}

// Dot product of three numbers from `a` on, `step` apart, with v.
VOLCOMP_SHARED inline double dot_of(const double* a, std::ptrdiff_t step, const Vec3& v) {
  return a[0] * v[0] + a[step] * v[1] + a[2 * step] * v[2];
}

// R v; matrices lie in columns
VOLCOMP_SHARED inline Vec3 turned(const Mat3& R, const Vec3& v) {
  const double* const a = R.data();
  return {dot_of(a, 3, v), dot_of(a + 1, 3, v), dot_of(a + 2, 3, v)};
}

// Rᵀ v
VOLCOMP_SHARED inline Vec3 turned_back(const Mat3& R, const Vec3& v) {
  const double* const a = R.data();
  return {dot_of(a, 1, v), dot_of(a + 3, 1, v), dot_of(a + 6, 1, v)};
}

// a × b
VOLCOMP_SHARED inline Vec3 crossed(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
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
  const double square = dot_of(v.data(), 1, v);
  const auto root = static_cast<double>(std::sqrt(static_cast<float>(square)));
  return root > 0.0 ? 0.5 * (root + square / root) : root;
}

}  // namespace volcomp
