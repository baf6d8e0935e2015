#include "comp/core/status.hpp"

namespace volcomp {

const char* code(Reason reason) {
  switch (reason) {
    case Reason::ok:
      return "ok";
    case Reason::not_finite:
      return "not_finite";
    case Reason::missing_field:
      return "missing_field";
    case Reason::no_runs:
      return "no_runs";
    case Reason::run_length:
      return "run_length";
    case Reason::too_many_runs:
      return "too_many_runs";
    case Reason::positions_not_monotone:
      return "positions_not_monotone";
    case Reason::positions_duplicate:
      return "positions_duplicate";
    case Reason::positions_not_uniform:
      return "positions_not_uniform";
    case Reason::gap_too_large:
      return "gap_too_large";
    case Reason::reference_out_of_range:
      return "reference_out_of_range";
    case Reason::unit_suspected:
      return "unit_suspected";
    case Reason::too_few_knots:
      return "too_few_knots";
    case Reason::too_many_knots:
      return "too_many_knots";
    case Reason::pitch_not_positive:
      return "pitch_not_positive";
    case Reason::travel_too_long:
      return "travel_too_long";
    case Reason::not_periodic:
      return "not_periodic";
    case Reason::bad_magic:
      return "bad_magic";
    case Reason::version_unknown:
      return "version_unknown";
    case Reason::image_truncated:
      return "image_truncated";
    case Reason::crc_mismatch:
      return "crc_mismatch";
    case Reason::machine_mismatch:
      return "machine_mismatch";
    case Reason::axes_mismatch:
      return "axes_mismatch";
    case Reason::bound_exceeded:
      return "bound_exceeded";
    case Reason::contraction_exceeded:
      return "contraction_exceeded";
    case Reason::parent_not_lower:
      return "parent_not_lower";
    case Reason::not_one_root:
      return "not_one_root";
    case Reason::bad_body:
      return "bad_body";
    case Reason::too_many_bodies:
      return "too_many_bodies";
    case Reason::too_many_axes:
      return "too_many_axes";
    case Reason::bad_joint:
      return "bad_joint";
    case Reason::not_a_rotation:
      return "not_a_rotation";
    case Reason::bad_axis_index:
      return "bad_axis_index";
    case Reason::no_authority:
      return "no_authority";
    case Reason::bad_setting:
      return "bad_setting";
    case Reason::lever_mismatch:
      return "lever_mismatch";
    case Reason::lever_spread_too_small:
      return "lever_spread_too_small";
    case Reason::too_few_points:
      return "too_few_points";
    case Reason::hand_over_pending:
      return "hand_over_pending";
    case Reason::not_staged:
      return "not_staged";
    case Reason::length_mismatch:
      return "length_mismatch";
    case Reason::coincident:
      return "coincident";
    case Reason::collinear:
      return "collinear";
    case Reason::rank_deficient:
      return "rank_deficient";
    case Reason::inside_base_circle:
      return "inside_base_circle";
    case Reason::out_of_standard:
      return "out_of_standard";
    case Reason::out_of_reach:
      return "out_of_reach";
    case Reason::no_z_authority:
      return "no_z_authority";
    case Reason::zero_normal:
      return "zero_normal";
    case Reason::implausible_radius:
      return "implausible_radius";
    case Reason::residuals_too_large:
      return "residuals_too_large";
    case Reason::parent_not_identified:
      return "parent_not_identified";
    case Reason::wrong_flank:
      return "wrong_flank";
    case Reason::bad_gear:
      return "bad_gear";
    case Reason::inside_gear_base:
      return "inside_gear_base";
    case Reason::no_regular_flank:
      return "no_regular_flank";
    case Reason::below_involute:
      return "below_involute";
    case Reason::undercut:
      return "undercut";
    case Reason::in_fillet:
      return "in_fillet";
    case Reason::above_tip:
      return "above_tip";
    case Reason::bad_point:
      return "bad_point";
    case Reason::two_flanks:
      return "two_flanks";
    case Reason::opposite_flank:
      return "opposite_flank";
    case Reason::ball_in_metal:
      return "ball_in_metal";
    case Reason::nothing_touched:
      return "nothing_touched";
    case Reason::frame_not_fixed:
      return "frame_not_fixed";
    case Reason::no_involute_at_tip:
      return "no_involute_at_tip";
    case Reason::pointed_space:
      return "pointed_space";
    case Reason::wheel_too_large:
      return "wheel_too_large";
    case Reason::no_contact:
      return "no_contact";
    case Reason::breaks_helix:
      return "breaks_helix";
    case Reason::feed_mismatch:
      return "feed_mismatch";
    case Reason::pass_discarded:
      return "pass_discarded";
    case Reason::no_deviation:
      return "no_deviation";
    case Reason::outlier:
      return "outlier";
    case Reason::incomplete:
      return "incomplete";
    case Reason::centre_missing:
      return "centre_missing";
    case Reason::partial:
      return "partial";
    case Reason::surface_not_determined:
      return "surface_not_determined";
    case Reason::not_converged:
      return "not_converged";
    case Reason::bad_thermal:
      return "bad_thermal";
    case Reason::expired:
      return "expired";
    case Reason::cannot_orient:
      return "cannot_orient";
  }
  return "unknown";
}

const char* sentence(Reason reason) {
  if (const char* const text = loading_sentence(reason); text != nullptr) return text;
  switch (reason) {
    case Reason::missing_field:
      return "A mandatory field is absent; there is no default for it.";
    case Reason::no_runs:
      return "There is no run in either direction.";
    case Reason::run_length:
      return "A run has another number of readings than there are targets.";
    case Reason::too_many_runs:
      return "There are more than 100 runs in one direction.";
    case Reason::positions_not_monotone:
      return "The target positions are not in order.";
    case Reason::positions_duplicate:
      return "A target position occurs twice.";
    case Reason::positions_not_uniform:
      return "The target positions are not equally spaced and resampling was not allowed.";
    case Reason::gap_too_large:
      return "A gap between targets is more than twice the median spacing; resampling would invent "
             "data.";
    case Reason::reference_out_of_range:
      return "The reference knot lies outside the table.";
    case Reason::unit_suspected:
      return "The magnitude is implausible; micrometres, arc seconds, microradians or metres were "
             "probably given instead of mm and rad.";
    case Reason::lever_mismatch:
      return "The lever self-test failed: sign, unit or order of the angles or arms is wrong.";
    case Reason::lever_spread_too_small:
      return "The angles change too little for the lever self-test to mean anything.";
    case Reason::too_few_points:
      return "There are too few points for this evaluation.";
    case Reason::length_mismatch:
      return "Two lists that belong together have different lengths.";
    case Reason::coincident:
      return "All points are the same point.";
    case Reason::collinear:
      return "The points lie on a line; they determine no circle.";
    case Reason::rank_deficient:
      return "The targets do not determine all six error motions; at least three are needed that "
             "do not lie on a line.";
    case Reason::inside_base_circle:
      return "The point lies inside the base circle, where there is no involute.";
    case Reason::out_of_standard:
      return "The gear is outside the sizes the standard covers.";
    case Reason::out_of_reach:
      return "The height is beyond the length of the arm.";
    case Reason::no_z_authority:
      return "The arm stands so upright that swinging it hardly changes the height.";
    case Reason::zero_normal:
      return "The surface normal has no length.";
    case Reason::implausible_radius:
      return "The effective radius is not between 0 and the radius of the ball + 0.05 mm; it is "
             "R_c of the circle minus the radius of the mandrel.";
    case Reason::residuals_too_large:
      return "The points are farther from the fit than is allowed.";
    case Reason::parent_not_identified:
      return "An axis that this one hangs on has moved, and its errors are not identified yet.";
    case Reason::wrong_flank:
      return "The point is more than 0.5 mm off the flank; another tooth or side was probably "
             "touched.";
    case Reason::bad_gear:
      return "The gear cannot be made like this or not be used between these radii; correct "
             "the field, the gear in use stays.";
    case Reason::inside_gear_base:
      return "The point lies inside the base radius of the gear; the frame or the gear is the "
             "wrong one.";
    case Reason::no_regular_flank:
      return "There is no regular flank at this radius and depth, it is cut away there; "
             "measure farther out or nearer to the tip.";
    case Reason::below_involute:
      return "The foot of the point lies before the beginning of the involute; measure nearer "
             "to the tip.";
    case Reason::undercut:
      return "The foot of the point lies on the part of the surface that is cut away; measure "
             "farther out.";
    case Reason::in_fillet:
      return "The foot of the point lies in the fillet that the tip of the shaper cuts; the "
             "value is not one of the flank.";
    case Reason::above_tip:
      return "The foot of the point lies beyond the edge of the tip; the value is not one of "
             "the flank.";
    case Reason::bad_point:
      return "The touch cannot be judged: slot, side, radius of the ball, gate or position are "
             "unusable.";
    case Reason::two_flanks:
      return "The ball touches both flanks of the slot; it is too big to measure here.";
    case Reason::opposite_flank:
      return "The opposite flank of the slot was touched; retract, and do not count the point "
             "for either side.";
    case Reason::ball_in_metal:
      return "The centre of the ball would be inside the metal; frame or slot is wrong, do not "
             "go on.";
    case Reason::nothing_touched:
      return "The ball is not at a flank; the probe triggered in the air or has lost its "
             "stylus.";
    case Reason::frame_not_fixed:
      return "The points do not fix the frame; touch both sides of at least three slots, or "
             "ask for the rotation about the axis only.";
    case Reason::no_involute_at_tip:
      return "The tip circle is not larger than the base circle; the flank has no involute up "
             "to its tip.";
    case Reason::pointed_space:
      return "The two flanks of a space meet before the root circle.";
    case Reason::wheel_too_large:
      return "The wheel does not pass the bore of the gear; its radius must be below the tip "
             "radius.";
    case Reason::no_contact:
      return "Wheel and flank do not touch where a contact is possible; the screw parameter or "
             "the profile is wrong.";
    case Reason::breaks_helix:
      return "Z and C follow one helix; learning one of them alone would put its lag on the "
             "flank.";
    case Reason::feed_mismatch:
      return "The offset table was learned at another feed rate, more than 2 % off.";
    case Reason::pass_discarded:
      return "More than 1 % of the samples of the pass are bad; the pass does not count.";
    case Reason::no_deviation:
      return "The deviation is not a positive number; there is no grade.";
    case Reason::outlier:
      return "A point deviates too much from the fit; the result was not taken over.";
    case Reason::incomplete:
      return "Measured values are missing; there is no grade.";
    case Reason::centre_missing:
      return "The centre of the map was not measured; it cannot be zeroed there.";
    case Reason::partial:
      return "Not every tooth was measured; there is no total pitch deviation.";
    case Reason::surface_not_determined:
      return "The measured cells do not determine a surface of this degree.";
    case Reason::not_converged:
      return "The iteration did not settle.";
    default:
      return "Unknown reason.";
  }
}

}  // namespace volcomp
