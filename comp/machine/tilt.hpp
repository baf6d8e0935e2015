#pragma once
// What two rotary axes can do about the direction of the tool's axis, the same in double off line
// and in float at run time.
//
// An axis of direction n moves the tool's axis k by n × k per radian, and the tool is off by ω × k:
// of a turn about k nothing is seen. Least squares of the two; where the axes lose their grip
// (n along k, or both n in one plane with k) they let go gradually instead of racing: damped least
// squares after Nakamura and Hanafusa (J. Dyn. Syst. Meas. Control 108, 1986), their damping chosen
// so that nothing is damped as long as the determinant reaches kMinTurning².

#include <array>
#include <cstddef>

#include "comp/machine/machine_description.hpp"

namespace volcomp {

// Sine of the angle between an axis and the tool, or between what two of them do. As for positions
// (kMinAuthority, conventions, section 4).
inline constexpr double kMinTurning = 0.1;

template <class Real>
struct TiltEquations {
  Real t11 = 1;  // products of n × k with each other
  Real t12 = 0;
  Real t22 = 1;  // a missing axis does what no other does
  Real b1 = 0;   // and with ω × k
  Real b2 = 0;
};

// Turns of the two axes, rad, that together with the error ω leave the axis of the tool where the
// ideal machine holds it, after a change of sign.
template <class Real>
constexpr std::array<Real, kMaxOrienting> solve_tilt(const TiltEquations<Real>& e) {
  constexpr Real kGrip = static_cast<Real>(kMinTurning * kMinTurning);
  const Real plain = e.t11 * e.t22 - e.t12 * e.t12;
  const Real damping = plain < kGrip ? kGrip - plain : Real{0};
  const Real m11 = e.t11 + damping;
  const Real m22 = e.t22 + damping;
  const Real scale = Real{1} / (m11 * m22 - e.t12 * e.t12);
  return {scale * (m22 * e.b1 - e.t12 * e.b2), scale * (m11 * e.b2 - e.t12 * e.b1)};
}

}  // namespace volcomp
