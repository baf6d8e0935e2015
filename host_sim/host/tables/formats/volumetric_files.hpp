#pragma once
// Writes a volumetric model of a three-axis machine as the one-dimensional tables a controller has:
// $AA_ENC_COMP for an axis on itself, $AN_CEC for it on the other two. The products of an angle and
// another axis do not fit nine functions; their error is measured and reported (docs/formats.md,
// "What is written").

#include <array>

#include "comp/metrology/tables/per_axis.hpp"
#include "comp/metrology/tables/volumetric_model.hpp"
#include "host_sim/host/tables/formats/siemens_cec.hpp"
#include "host_sim/host/tables/formats/siemens_enc_comp.hpp"

namespace volcomp::host {

struct VolumetricFiles {
  std::array<EncCompTable, 3> own;  // X1, Y1, Z1
  std::array<CecTable, 6> cross;    // input ≠ output
  Vec3 remainder_max_um = Vec3::Zero();
  double remainder_rms_um = 0.0;
};

// NC axes 0, 1, 2 = X, Y, Z of `model`; mean of both directions. Offsets are −E. Refused:
// too_few_knots, too_many_knots (axis) outside 2…129, axes_mismatch.
Status volumetric_files(const VolumetricModel& model, const std::array<KnotGrid, 3>& grid,
                        VolumetricFiles& out);

}  // namespace volcomp::host
