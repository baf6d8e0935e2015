#pragma once
// Profile of internal gears from deviations of their flanks. What differs from external gears is
// the sign of the slope: the tip is at the SMALL end of the roll length. Pitch is that of all gears
// (pitch.hpp).

#include "comp/metrology/gears/gear_deviations.hpp"

namespace volcomp {

// Profile: all points count. `slope` (f_Hα) is positive when material grows towards the tip. Units
// and refusals as evaluate_trace().
Status evaluate_internal_profile(Span<const double> roll_length, Span<const double> deviation,
                                 TraceDeviations& out);

}  // namespace volcomp
