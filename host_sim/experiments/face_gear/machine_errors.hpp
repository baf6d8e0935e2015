#pragma once
// The YK7280 as it really is: at the limits that the paper publishes in its section 3.1, the rest
// chosen (docs/papers/face-gear.md, "The machine").

#include <cstdint>

#include "comp/core/units.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::face_gear {

// Published. Each straightness is at its limit in the worst 200 mm, each run-out at its limit when
// its waves add up; the directions of the axes lie anywhere within theirs.
inline constexpr double kStraightness_mm = 2e-3;
inline constexpr double kStraightnessLength_mm = 200.0;
inline constexpr double kRunOut_mm = 1.5e-3;              // of the table, radial and axial
inline constexpr double kSquareness_rad = 10e-3 / 267.0;  // between slides, and to the table
inline constexpr double kParallelism_rad = 2e-3 / 200.0;  // of Z to the axis of the table

// Chosen: amplitudes.
inline constexpr double kPositioning_mm = 3e-3;      // of a slide
inline constexpr double kSlideAngle_rad = 10e-6;     // of its three angles
inline constexpr double kTablePosition_rad = 10e-6;  // of C
inline constexpr double kTableRim_mm = 200.0;  // where tilting adds no more than the axial run-out

// Smooth errors, phases and directions from `seed`. Throws UserError when the machine has other
// axes than X Y Z C.
[[nodiscard]] sim::TrueMachine make_yk7280_truth(const host::MachineFile& file, std::uint64_t seed);

// Largest range of a function about the line through its ends, over all pieces of `length` between
// `lo` and `hi`; the whole of it when it is shorter. To about 1 %.
[[nodiscard]] double straightness_over(const sim::ErrorFunction& f, double lo, double hi,
                                       double length);

}  // namespace volcomp::face_gear
