#pragma once
// Compares the geometry of the simulation with the exact envelope (docs/papers/internal-helical.md,
// "What we do").

#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::internal_helical {

struct GeometryCheck {
  double regenerated_nm = 0.0;  // worst miss of the flank by a wheel of 17 knots and ideal motion
  double single_nm = 0.0;       // worst miss of the first order: one error of 10 µm or 100 µrad
  double all_nm = 0.0;          // 24 errors of 5 µm and 50 µrad rms at once, 95 of 100 draws
};

// Throws UserError where there is no contact.
[[nodiscard]] GeometryCheck check_grinding_geometry(const host::GrindingFile& job);

}  // namespace volcomp::internal_helical
