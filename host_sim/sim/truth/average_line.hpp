#pragma once
// What of the errors of an axis is motion, and what is not: a rotary axis turns about its average
// line (ISO 230-7), and where that line is, is its location error (ISO 230-1, 3.6); what is
// constant in the frame that moves is where the next body is mounted on it, or where the machine
// counts from.

#include <vector>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// All body values, mm and rad: error = motion + fixed, turned into the moving frame, + moving. The
// motion is 0 at the reference, and across a rotary axis its mean in the fixed frame is 0.
struct AverageLine {
  ErrorMotion fixed = ErrorMotion::Zero();  // location error; of a linear axis 0
  ErrorMotion moving = ErrorMotion::Zero();
};

// What it makes of the error of the axis at a place: all but the motion.
[[nodiscard]] ErrorMotion error_of(const AverageLine& line, const Joint& joint, double q);

// `error`: at the targets of the axis, internal convention. The reference is the target nearest to
// that of the machine file.
[[nodiscard]] AverageLine average_line(const host::AxisFile& axis, const Joint& joint,
                                       const std::vector<ErrorMotion>& error);

// Mean of both directions.
[[nodiscard]] AverageLine true_line(const TrueMachine& truth, const host::MachineFile& file,
                                    std::size_t axis);

// The same machine with all its axes right where they count from: nothing constant in a moving
// frame is left.
[[nodiscard]] TrueMachine counted_from_references(TrueMachine truth, const host::MachineFile& file);

}  // namespace volcomp::sim
