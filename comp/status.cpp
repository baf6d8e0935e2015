#include "comp/status.hpp"

// By itself: an image that asks for nothing else carries no other text (reason_text.cpp).

namespace volcomp {

Status refuse_value(Reason reason, const char* field, double value) {
  Where where;
  where.field = field;
  where.value = value;
  where.has_value = true;
  return refuse(reason, where);
}

const char* loading_sentence(Reason reason) {
  switch (reason) {
    case Reason::ok:
      return "Accepted.";
    case Reason::not_finite:
      return "A value is NaN or infinite.";
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
    case Reason::too_few_knots:
      return "A table needs at least two knots.";
    case Reason::too_many_knots:
      return "The table has more knots than this build can hold.";
    case Reason::pitch_not_positive:
      return "The knot spacing must be at least one unit (1 nm).";
    case Reason::travel_too_long:
      return "The table is longer than 4.29 m, the range of the run-time lookup.";
    case Reason::not_periodic:
      return "A full-turn rotary table must start and end with the same values.";
    case Reason::bad_magic:
      return "This is not a volcomp table image.";
    case Reason::version_unknown:
      return "The image was written in a format version this build does not read.";
    case Reason::image_truncated:
      return "The image is shorter or longer than its header says.";
    case Reason::crc_mismatch:
      return "The checksum is wrong; the image is damaged.";
    case Reason::machine_mismatch:
      return "The image was built for another machine.";
    case Reason::axes_mismatch:
      return "The tables do not match the axes of the machine.";
    case Reason::bound_exceeded:
      return "The corrections these tables can produce exceed what the tick can represent.";
    case Reason::contraction_exceeded:
      return "The errors change faster than 10 um per mm; tables like that are not plausible.";
    case Reason::parent_not_lower:
      return "A body must be attached to a body with a lower number.";
    case Reason::not_one_root:
      return "Exactly one body must be the root (lower body 0).";
    case Reason::bad_body:
      return "The work or tool body does not exist.";
    case Reason::too_many_bodies:
      return "The machine has more bodies than this build can hold.";
    case Reason::too_many_axes:
      return "The machine has more than eight axes.";
    case Reason::bad_joint:
      return "A joint needs an axis X, Y or Z and a sign of +1 or -1.";
    case Reason::not_a_rotation:
      return "The orientation of a fixed offset is not a rotation matrix.";
    case Reason::bad_axis_index:
      return "The axis numbers must be 0, 1, 2 ... without gap or repetition.";
    case Reason::no_authority:
      return "The correcting axes cannot move the tool point in every direction here.";
    case Reason::bad_setting:
      return "A setting is outside its range.";
    case Reason::lever_mismatch:
      return "The lever self-test failed: sign, unit or order of the angles or arms is wrong.";
    case Reason::lever_spread_too_small:
      return "The angles change too little for the lever self-test to mean anything.";
    case Reason::too_few_points:
      return "There are too few points for this evaluation.";
    case Reason::hand_over_pending:
      return "The tick has not yet taken over the tables handed to it before; try again.";
    case Reason::not_staged:
      return "There is no validated table set to activate.";
    default:
      return nullptr;
  }
}

}  // namespace volcomp
