#pragma once
// What errors of the axes leave on a ground flank, by the envelope theorem: to first order the
// envelope moves by the normal displacement of the generating surface at the contact point, so a
// flank point shows the errors of the instant at which the wheel touches it. Replaces eq. 22 of the
// paper (docs/papers/internal-helical.md), which compares points of equal parameter and so contains
// their slide along the flank.
//
// Lengths mm; dn > 0 is excess material. The exact envelope is in flank_envelope.hpp.

#include "comp/core/span.hpp"
#include "comp/metrology/gears/form_wheel.hpp"
#include "comp/metrology/gears/internal_grinder.hpp"
#include "comp/metrology/tables/left_error.hpp"

namespace volcomp {

// A point of the flank of space 0.
struct FlankPlace {
  FlankSide side = FlankSide::left;
  double radius = 0.0;
  double z = 0.0;
};

// When the wheel touches it.
struct ContactInstant {
  Vec3 P;               // in the gear frame
  Vec3 n;               // out of the material
  double stroke = 0.0;  // Z of the machine
  double c = 0.0;       // C of the machine, rad: −stroke / p
};

// Refuses what wheel_contact() refuses.
Status contact_instant(const InternalGear& gear, const WheelSetup& setup, const FlankPlace& place,
                       ContactInstant& out);

// Where the internal grinder stands at a stroke position, C following Z.
[[nodiscard]] Pose grinding_pose(const InternalGear& gear, const WheelSetup& setup, double stroke);

// dn = n · (delta + eps × P), delta and eps at that instant.
[[nodiscard]] double flank_deviation(const ContactInstant& instant, const LeftError& error);

// The same as a gradient: dn is Σ rows[axis].dot(error motion of the axis), for one side and radius
// a constant of the machine up to the turn of C. Refuses what contact_instant() refuses.
Status flank_sensitivity(const MachineChain& chain, const InternalGear& gear,
                         const WheelSetup& setup, const FlankPlace& place, SensitivityRows& rows);

// --- synchronism of Z and C (docs/papers/internal-helical.md, "What we do")

// e_s = e_C + e_Z / p, rad; errors as actual − original command, mm and rad. The part of both that
// does not follow the helix; a lag common to both leaves no mark.
[[nodiscard]] double synchronisation_error(const InternalGear& gear, double e_z, double e_c);

// What it is on a flank of side +1, mm.
[[nodiscard]] double synchronisation_on_flank(const InternalGear& gear, double e_s);

// --- validity: the wheel leaves the LOWER envelope of its positions

// κ at a radius, 1/mm: a wheel that stands dz along the helix from where it touches a point stands
// κ dz²/2 off it. Refuses what wheel_contact() refuses, no_contact.
Status contact_curvature(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                         double radius, double& kappa);

// The largest amplitude (mm) of an error that varies along Z with this wavelength (mm) for which
// the first order holds: κ λ² / (4π²). Beyond it crests are cut.
[[nodiscard]] double first_order_limit(double kappa, double wavelength);

// What an error of that wavelength leaves at most, peak to valley, however large: κ λ² / 8.
[[nodiscard]] double most_waviness(double kappa, double wavelength);

struct LowerEnvelope {
  double dn = 0.0;          // min over k of κ dz²/2 + dn1[k]
  bool first_order = true;  // the minimum is as good as at the contact itself
};

// `first_order_dn`: first-order deviations of one flank point with the errors of stroke positions
// `spacing` mm apart, the contact at `centre`. `first_order` is false where the cut crest differs
// from the first order by more than `tolerance`, mm.
[[nodiscard]] LowerEnvelope lower_envelope(double kappa, Span<const double> first_order_dn,
                                           double spacing, std::size_t centre, double tolerance);

}  // namespace volcomp
