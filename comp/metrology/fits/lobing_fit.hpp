#pragma once
// The lobing map of a probe (comp/probe/lobing.hpp) from effective radii measured in several
// directions: on a sphere of radius R about p, a ball centre c gives the radius |c − p| − R in the
// direction c − p.

#include <cstddef>
#include <cstdint>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/probe/lobing.hpp"

namespace volcomp {

struct LobingFit {
  LobingMap map;            // in the unit of the radii
  std::uint32_t known = 0;  // a bit per coefficient; the others are 0
  int rank = 0;             // how many are known
  LobingTerms cofactor{};   // variance of each known coefficient over that of a radius
  double rms = 0.0;         // residuals over max(1, n − rank) degrees of freedom
  double largest = 0.0;     // residual of largest magnitude, signed
  std::size_t worst = 0;    // its direction
};

// Least squares. A term that the directions do not separate from those before it stays 0:
// directions in a plane determine seven of sixteen. `direction`: unit vectors in the tool frame.
// Refused, in this order: length_mismatch, too_few_points (none), not_finite (index), bad_setting
// (index: no unit vector).
Status fit_lobing(Span<const Vec3> direction, Span<const double> radius, LobingFit& out);

}  // namespace volcomp
