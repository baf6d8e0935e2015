#pragma once
// Decides which signal is worth a table, and which must not get one alone: signals are judged by
// their effect on the flank, not in mm against degrees (docs/papers/internal-helical.md).

#include "comp/strokes/learning.hpp"

namespace volcomp {

// How much of a signal comes back in every pass, from its node sums; units of the signal.
struct Repeatability {
  double amplitude = 0.0;  // A_rep: half the range of the node means
  double noise = 0.0;      // largest standard deviation of a node mean
  double ratio = 0.0;      // R: variance of the means over that plus the mean variance of a mean
  std::size_t nodes = 0;   // with enough samples
};
[[nodiscard]] Repeatability repeatability(Span<const NodeSums> nodes, std::uint32_t least_samples);

enum class LearningVerdict : std::uint8_t {
  compensate,
  too_small,        // against the tolerance of what it feeds
  not_significant,  // below three standard deviations of a node
  not_repeatable,   // large, but another one every time: report, do not learn
};

// `flank_per_unit`: |µm| on the flank per unit of the signal; `tolerance_um` of the parameter it
// feeds (ISO 1328-1); `share` of it that is tolerated uncompensated, 0.1…0.3.
[[nodiscard]] LearningVerdict judge_signal(const Repeatability& signal, double flank_per_unit,
                                           double tolerance_um, double share);

enum class LearningTarget : std::uint8_t {
  synchronisation,  // e_s on one axis
  z_and_c,          // both lags, completely and together
  z_alone,
  c_alone,
};

// What the flank shows, µm: of the lags one by one, and of what is left of both together.
struct HelixEffect {
  double z_um = 0.0;
  double c_um = 0.0;
  double together_um = 0.0;
};

// Whether these lags (e_z mm, e_c rad) may be learned from. `prediction` holds what the flank shows
// when the other one is left alone, whatever is decided. Refused: breaks_helix (value = µm left on
// the flank) for Z or C alone while both follow the helix, unless `forced`; not_finite.
// `flank_per_rad`: r_b cos β_b in mm/rad, `turn_per_mm`: 1/p.
Status check_learning_target(LearningTarget target, bool both_follow_helix, bool forced,
                             double flank_per_rad, double turn_per_mm, double e_z, double e_c,
                             HelixEffect& prediction);

// Errors of C (rad) and X (mm) behind the deviations of the two flanks of a space (mm): the odd
// part is C, the even part X. dn(s) = s · flank_per_rad · e_C − flank_per_x · e_X.
struct FlankPairErrors {
  double e_c = 0.0;
  double e_x = 0.0;
};
[[nodiscard]] FlankPairErrors errors_of_flank_pair(double dn_plus, double dn_minus,
                                                   double flank_per_rad, double flank_per_x);

}  // namespace volcomp
