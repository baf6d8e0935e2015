#pragma once
// Pitch deviations of one round of measurements, all flanks of one side: cylindrical gears
// (docs/papers/l300g.md) and face gears (docs/papers/face-gear.md, eq. 34 to 38) alike. A round is
// closed: the tooth before the first is the last.
//
// `position`: how far each tooth is from where it should be, as length or as angle; NaN: not
// measured. `scale` multiplies every result: 1 for lengths; for angles the radius of the pitch
// circle, or the moment arm C of a face gear's normals for the direction normal to the flank (C/r₁
// times the arc, the cosine of the pressure angle).

#include <array>
#include <cstddef>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"

namespace volcomp {

inline constexpr std::size_t kMaxPitchTeeth = 256;

// One round of a face gear as it is probed, tooth by tooth, angles in rad.
class ToothAngles {
 public:
  // Nothing measured yet. Refused: bad_setting 'teeth' unless 2…kMaxPitchTeeth.
  static Status of(int teeth, ToothAngles& out);

  // The ball on tooth k, turned back to slot 0, stood off the nominal flank by `deviation` (signed
  // distance less the radius of the ball, + = excess material) on side +1 or −1; `moment_arm`: C of
  // the gear, mm. Stores δ_k = −side · deviation / C, exact also where the touches lie at other
  // radii and heights. Refused: bad_setting 'tooth', 'side' or 'moment_arm', not_finite.
  Status record(int tooth, int side, double deviation, double moment_arm);

  [[nodiscard]] Span<const double> angles() const { return {angle_.data(), teeth_}; }

 private:
  std::array<double, kMaxPitchTeeth> angle_{};
  std::size_t teeth_ = 0;
};

struct PitchDeviations {
  double total = 0.0;   // F_p
  double single = 0.0;  // f_pt, magnitude
  double single_signed = 0.0;
  std::size_t tooth = 0;  // where f_pt is largest: between this tooth and the one before
};

// All of a whole round. Refused: too_few_points (count) for fewer than 2, incomplete (index of the
// first that is missing, count of all), not_finite (index).
Status evaluate_pitch(Span<const double> position, PitchDeviations& out, double scale = 1.0);

// f_pt,k of every tooth: its position less that of the one before; NaN where either is missing.
// Refused: too_few_points, length_mismatch, not_finite (index) for an infinite value.
Status single_pitches(Span<const double> position, Span<double> out, double scale = 1.0);

// F_pk: the largest sum of k pitches in a row, wherever it starts; k within 1…teeth − 1. Standards
// evaluate k up to largest_pitch_span. Refused as evaluate_pitch, and bad_setting 'k'.
Status cumulative_pitch(Span<const double> position, std::size_t k, double& out,
                        double scale = 1.0);

// An eighth of the round, at least one pitch.
[[nodiscard]] constexpr std::size_t largest_pitch_span(std::size_t teeth) {
  return teeth < 16 ? 1 : teeth / 8;
}

// Results with teeth missing: pitches of neighbours that are both there.
struct PartialPitch {
  double single = 0.0;  // f_pt, magnitude
  double single_signed = 0.0;
  std::size_t tooth = 0;
  std::size_t pitches = 0;            // of neighbours that are both there
  std::size_t missing = 0;            // teeth that were not measured
  Reason no_total = Reason::partial;  // why there is no F_p; ok: nothing is missing
};

// Refused: too_few_points (count of pitches) where no two neighbours are there, not_finite.
Status evaluate_partial_pitch(Span<const double> position, PartialPitch& out, double scale = 1.0);

}  // namespace volcomp
