#pragma once
// Profile and pitch of internal gears from deviations of their flanks. What differs from external
// gears is the sign of the slope: the tip is at the SMALL end of the roll length. Seed 003
// section 5.

#include "comp/evaluation/gear_deviations.hpp"

namespace volcomp {

// Profile: all points count. `slope` (f_Hα) is positive when material grows towards the tip. Units
// and refusals as evaluate_trace().
Status evaluate_internal_profile(Span<const double> roll_length, Span<const double> deviation,
                                 TraceDeviations& out);

// f_pt of every tooth: position[k] − position[k − 1]; k = 0 closes the circle. `single` has the
// length of `position`. Refused: length_mismatch, too_few_points (count), not_finite (index).
Status single_pitch_deviations(Span<const double> position, Span<double> single);

// F_pk: the largest |position[j + k] − position[j]| around the circle, 0 < k < teeth. Refused as
// above, and bad_setting ("k").
Status sector_pitch_deviation(Span<const double> position, std::size_t k, double& out);

}  // namespace volcomp
