#pragma once
// The flank that a wheel on a machine with errors leaves, exactly: at every point of the flank the
// lowest of all positions of the wheel along its stroke. No linearisation: it checks the first
// order of flank_error.hpp and grinds simulated gears (docs/papers/internal-helical.md, "What we
// do").
//
// Host and commissioning: some 130 wheel positions per point.

#include <algorithm>

#include "comp/metrology/gears/flank_error.hpp"

namespace volcomp {

// Wheel frame → gear frame at a stroke position, the gear turning along.
[[nodiscard]] Frame generating_frame(const InternalGear& gear, const WheelSetup& setup,
                                     double stroke);

// From a flank point along its normal to the surface of the wheel in this pose (wheel frame → gear
// frame), mm; positive: the wheel leaves material. At most 30 Newton steps; refused:
// no_contact where they do not end.
Status wheel_gap(const WheelProfile& profile, const Frame& wheel, const SpaceFlankPoint& flank,
                 double& gap);

// How far either way from the contact wheel positions are searched, mm.
inline constexpr double kEnvelopeReach = 4.0;

namespace detail {

// The least value of `gap(stroke, value)` about `centre`: scanned, then narrowed by the golden
// section.
template <class Gap>
Status least_gap(const Gap& gap, double centre, double& least) {
  constexpr int kScan = 80;
  constexpr int kNarrow = 36;  // (0.618)^36 of 0.2 mm
  constexpr double kStep = 2.0 * kEnvelopeReach / kScan;
  constexpr double kGolden = 0.6180339887498949;
  double best = centre;
  double value = 0.0;
  for (int i = 0; i <= kScan; ++i) {
    const double at = centre - kEnvelopeReach + kStep * i;
    if (const Status s = gap(at, value); !s.ok()) return s;
    if (i > 0 && value >= least) continue;
    least = value;
    best = at;
  }
  double low = best - kStep;
  double high = best + kStep;
  for (int i = 0; i < kNarrow; ++i) {
    const double width = kGolden * (high - low);
    double left = 0.0;
    double right = 0.0;
    if (const Status s = gap(high - width, left); !s.ok()) return s;
    if (const Status s = gap(low + width, right); !s.ok()) return s;
    least = std::min({least, left, right});
    if (left < right) {
      high = low + width;
    } else {
      low = high - width;
    }
  }
  return {};
}

}  // namespace detail

// dn of the flank point of `instant` on the machine `chain` (an internal_grinder()) whose errors at
// a pose are errors_at(pose), mm. `profile` must reach beyond the radius of the point. Refused:
// no_contact.
template <class ErrorsAt>
Status exact_flank_deviation(const MachineChain& chain, const InternalGear& gear,
                             const WheelSetup& setup, const WheelProfile& profile,
                             const ContactInstant& instant, const ErrorsAt& errors_at, double& dn) {
  const SpaceFlankPoint flank{instant.P, instant.n};
  const auto gap = [&](double stroke, double& value) {
    const Pose q = grinding_pose(gear, setup, stroke);
    const Frame wheel = actual_tool_in_work(chain, q, errors_at(q), RotationModel::exponential);
    return wheel_gap(profile, wheel, flank, value);
  };
  return detail::least_gap(gap, instant.stroke, dn);
}

}  // namespace volcomp
