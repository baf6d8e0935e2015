#include "comp/core/status.hpp"

// In a file of its own: an image that uses nothing else links no other text (reason_text.cpp).

namespace volcomp {

Status refuse(Reason reason) { return {reason, {}}; }

Status refuse(Reason reason, const Where& where) { return {reason, where}; }

Status refuse_value(Reason reason, const char* field, double value) {
  Where where;
  where.field = field;
  where.value = value;
  where.has_value = true;
  return refuse(reason, where);
}

const char* loading_sentence(Reason reason) {
  // Not in the table of the switch, which ends far below them.
  if (reason == Reason::bad_thermal) return "Expansion, temperature or expiry is not usable.";
  if (reason == Reason::expired) return "The tables are past their expiry.";
  if (reason == Reason::cannot_orient) return "The tool cannot be oriented like this.";
  switch (reason) {
    case Reason::ok:
      return "Accepted.";
    case Reason::not_finite:
      return "A value is NaN or infinite.";
    case Reason::too_few_knots:
      return "A table needs at least two knots.";
    case Reason::too_many_knots:
      return "The table has too many knots for this build.";
    case Reason::pitch_not_positive:
      return "The knot spacing must be at least one unit (1 nm).";
    case Reason::travel_too_long:
      return "The table is longer than the lookup reaches, 4.29 m.";
    case Reason::not_periodic:
      return "The table of a full turn must end as it starts.";
    case Reason::bad_magic:
      return "This is not a volcomp table image.";
    case Reason::version_unknown:
      return "This build does not read images of that version.";
    case Reason::image_truncated:
      return "The image is shorter or longer than its header says.";
    case Reason::crc_mismatch:
      return "The checksum is wrong; the image is damaged.";
    case Reason::machine_mismatch:
      return "The image was built for another machine.";
    case Reason::axes_mismatch:
      return "The tables do not match the axes of the machine.";
    case Reason::bound_exceeded:
      return "These tables can ask for more than the tick can represent.";
    case Reason::contraction_exceeded:
      return "The errors change faster than 10 um per mm: not plausible.";
    case Reason::parent_not_lower:
      return "A body must hang on one with a lower number.";
    case Reason::not_one_root:
      return "Exactly one body must be the root (on body 0).";
    case Reason::bad_body:
      return "The work or tool body does not exist.";
    case Reason::too_many_bodies:
      return "The machine has too many bodies for this build.";
    case Reason::too_many_axes:
      return "The machine has more than eight axes.";
    case Reason::bad_joint:
      return "A joint needs an axis X, Y, Z and a sign 1 or -1.";
    case Reason::not_a_rotation:
      return "An orientation is not a rotation matrix.";
    case Reason::bad_axis_index:
      return "The axis numbers must be 0, 1, 2 ... each once.";
    case Reason::no_authority:
      return "The correcting axes have no authority here.";
    case Reason::bad_setting:
      return "A setting is outside its range.";
    case Reason::hand_over_pending:
      return "The tick has not yet taken the last tables; try again.";
    case Reason::not_staged:
      return "No validated tables wait to be activated.";
    default:
      return nullptr;
  }
}

}  // namespace volcomp
