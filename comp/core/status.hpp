#pragma once
// Why a call was refused, and where: every rejected input has its own reason, sentence and test.
//
// Nothing in comp throws. A function that can fail returns a Status that cannot be ignored and
// leaves everything it was given to write untouched.

#include <cstdint>

namespace volcomp {

enum class Reason : std::uint8_t {
  ok,
  not_finite,
  missing_field,
  no_runs,
  run_length,
  too_many_runs,
  positions_not_monotone,
  positions_duplicate,
  positions_not_uniform,
  gap_too_large,
  reference_out_of_range,
  unit_suspected,
  too_few_knots,
  too_many_knots,
  pitch_not_positive,
  travel_too_long,
  not_periodic,
  bad_magic,
  version_unknown,
  image_truncated,
  crc_mismatch,
  machine_mismatch,
  axes_mismatch,
  bound_exceeded,
  contraction_exceeded,
  parent_not_lower,
  not_one_root,
  bad_body,
  too_many_bodies,
  too_many_axes,
  bad_joint,
  not_a_rotation,
  bad_axis_index,
  no_authority,
  bad_setting,
  lever_mismatch,
  lever_spread_too_small,
  too_few_points,
  not_staged,
  hand_over_pending,
  length_mismatch,
  coincident,
  collinear,
  rank_deficient,
  inside_base_circle,
  out_of_standard,
  out_of_reach,
  no_z_authority,
  zero_normal,
  implausible_radius,
  residuals_too_large,
  parent_not_identified,
  wrong_flank,
  bad_gear,
  inside_gear_base,
  no_regular_flank,
  below_involute,
  undercut,
  in_fillet,
  above_tip,
  bad_point,
  two_flanks,
  opposite_flank,
  ball_in_metal,
  nothing_touched,
  frame_not_fixed,
  no_involute_at_tip,
  pointed_space,
  wheel_too_large,
  no_contact,
  breaks_helix,
  feed_mismatch,
  pass_discarded,
  no_deviation,
  outlier,
  incomplete,
  centre_missing,
  partial,
  surface_not_determined,
  not_converged,
  bad_thermal,
  expired,
  cannot_orient,
};

// What a Status points at. A negative number or an empty name means "does not apply".
struct Where {
  char axis = '\0';                 // axis letter
  const char* direction = nullptr;  // "up" or "down"
  const char* field = nullptr;      // name of the offending field or setting
  int run = -1;
  int target = -1;   // 0-based
  int channel = -1;  // 0…5 = EX EY EZ EA EB EC
  int index = -1;
  int body = -1;           // 1-based, as in a lower-body array
  int count = -1;          // how many there are (knots, bodies, axes)
  double value = 0.0;      // the offending value, where has_value
  double deviation = 0.0;  // signed distance from what was expected, where has_deviation
  bool has_value = false;
  bool has_deviation = false;
};

struct [[nodiscard]] Status {
  Reason reason = Reason::ok;
  Where where{};

  [[nodiscard]] constexpr bool ok() const { return reason == Reason::ok; }
};

// Functions of their own: a place is larger than the calls that fill it in, and boards have many.
Status refuse(Reason reason);
Status refuse(Reason reason, const Where& where);

// With the offending value of a field.
Status refuse_value(Reason reason, const char* field, double value);

// Stable machine-readable name, for instance "crc_mismatch".
[[nodiscard]] const char* code(Reason reason);

// One plain sentence for a person, without the place.
[[nodiscard]] const char* sentence(Reason reason);

// The same for what an image or a setting can be refused for; nullptr for other reasons.
[[nodiscard]] const char* loading_sentence(Reason reason);

}  // namespace volcomp
