#pragma once
// The effective radius of a probe ball by direction. A touch probe gives way before it triggers, by
// an amount that depends on where it is pushed; so the centre stands closer to the part than the
// ball is thick, by a different amount in each direction ("lobing").
//
// r(d) = Σ c_k Y_k(d), spherical harmonics up to third order as polynomials in the direction
// cosines. The first coefficient is the constant radius r_c of docs/papers/l300g.md; the next three
// are indistinguishable from a shift of the ball centre.

#include <array>
#include <cstddef>

#include "comp/machine/double3.hpp"

namespace volcomp {

inline constexpr std::size_t kLobingTerms = 16;

using LobingTerms = std::array<double, kLobingTerms>;

// Values of the harmonics in a unit direction: 1, three of first, five of second, seven of third
// order. Each is below 2 in magnitude.
inline LobingTerms lobing_terms(const Vec3& d) {
  const double x = d[0];
  const double y = d[1];
  const double z = d[2];
  const double xx = x * x;
  const double yy = y * y;
  const double zz = z * z;
  return {1.0,
          x,
          y,
          z,
          x * y,
          y * z,
          z * x,
          xx - yy,
          3.0 * zz - 1.0,
          x * (xx - 3.0 * yy),
          y * (3.0 * xx - yy),
          z * (xx - yy),
          x * y * z,
          x * (5.0 * zz - 1.0),
          y * (5.0 * zz - 1.0),
          z * (5.0 * zz - 3.0)};
}

// Same length unit as the coefficients.
struct LobingMap {
  LobingTerms coefficient{};

  // `d`: unit vector in the tool frame, along which the part pushes the ball.
  [[nodiscard]] double radius(const Vec3& d) const {
    const LobingTerms terms = lobing_terms(d);
    double r = 0.0;
    VOLCOMP_UNROLL_16
    for (std::size_t k = 0; k < kLobingTerms; ++k)
      r += coefficient[k] * terms[k];
    return r;
  }
};

}  // namespace volcomp
