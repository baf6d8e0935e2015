#include "comp/status.hpp"

#include <array>
#include <cstddef>

namespace volcomp {
namespace {

struct Entry {
  Reason reason;
  const char* code;
  const char* sentence;
};

constexpr Entry kEntries[] = {
    // NOLINT(modernize-avoid-c-arrays): the size is deduced
    {Reason::ok, "ok", "Accepted."},
    {Reason::not_finite, "not_finite", "A value is NaN or infinite."},
    {Reason::missing_field, "missing_field",
     "A mandatory field is absent; there is no default for it."},
    {Reason::no_runs, "no_runs", "There is no run in either direction."},
    {Reason::run_length, "run_length",
     "A run has another number of readings than there are targets."},
    {Reason::too_many_runs, "too_many_runs", "There are more than 100 runs in one direction."},
    {Reason::positions_not_monotone, "positions_not_monotone",
     "The target positions are not in order."},
    {Reason::positions_duplicate, "positions_duplicate", "A target position occurs twice."},
    {Reason::positions_not_uniform, "positions_not_uniform",
     "The target positions are not equally spaced and resampling was not allowed."},
    {Reason::gap_too_large, "gap_too_large",
     "A gap between targets is more than twice the median spacing; resampling would invent data."},
    {Reason::reference_out_of_range, "reference_out_of_range",
     "The reference knot lies outside the table."},
    {Reason::unit_suspected, "unit_suspected",
     "The magnitude is implausible; micrometres, arc seconds, microradians or metres were probably "
     "given instead of mm and rad."},
    {Reason::too_few_knots, "too_few_knots", "A table needs at least two knots."},
    {Reason::too_many_knots, "too_many_knots",
     "The table has more knots than this build can hold."},
    {Reason::pitch_not_positive, "pitch_not_positive",
     "The knot spacing must be at least one unit (1 nm)."},
    {Reason::travel_too_long, "travel_too_long",
     "The table is longer than 4.29 m, the range of the run-time lookup."},
    {Reason::not_periodic, "not_periodic",
     "A full-turn rotary table must start and end with the same values."},
    {Reason::bad_magic, "bad_magic", "This is not a volcomp table image."},
    {Reason::version_unknown, "version_unknown",
     "The image was written in a format version this build does not read."},
    {Reason::image_truncated, "image_truncated",
     "The image is shorter or longer than its header says."},
    {Reason::crc_mismatch, "crc_mismatch", "The checksum is wrong; the image is damaged."},
    {Reason::machine_mismatch, "machine_mismatch", "The image was built for another machine."},
    {Reason::axes_mismatch, "axes_mismatch", "The tables do not match the axes of the machine."},
    {Reason::bound_exceeded, "bound_exceeded",
     "The corrections these tables can produce exceed what the tick can represent."},
    {Reason::contraction_exceeded, "contraction_exceeded",
     "The errors change faster than 10 um per mm; tables like that are not plausible."},
    {Reason::parent_not_lower, "parent_not_lower",
     "A body must be attached to a body with a lower number."},
    {Reason::not_one_root, "not_one_root", "Exactly one body must be the root (lower body 0)."},
    {Reason::bad_body, "bad_body", "The work or tool body does not exist."},
    {Reason::too_many_bodies, "too_many_bodies",
     "The machine has more bodies than this build can hold."},
    {Reason::too_many_axes, "too_many_axes", "The machine has more than eight axes."},
    {Reason::bad_joint, "bad_joint", "A joint needs an axis X, Y or Z and a sign of +1 or -1."},
    {Reason::not_a_rotation, "not_a_rotation",
     "The orientation of a fixed offset is not a rotation matrix."},
    {Reason::bad_axis_index, "bad_axis_index",
     "The axis numbers must be 0, 1, 2 ... without gap or repetition."},
    {Reason::no_authority, "no_authority",
     "The correcting axes cannot move the tool point in every direction here."},
    {Reason::bad_setting, "bad_setting", "A setting is outside its range."},
    {Reason::lever_mismatch, "lever_mismatch",
     "The lever self-test failed: sign, unit or order of the angles or arms is wrong."},
    {Reason::lever_spread_too_small, "lever_spread_too_small",
     "The angles change too little for the lever self-test to mean anything."},
    {Reason::too_few_points, "too_few_points", "There are too few points for this evaluation."},
    {Reason::hand_over_pending, "hand_over_pending",
     "The tick has not yet taken over the tables handed to it before; try again."},
    {Reason::not_staged, "not_staged", "There is no validated table set to activate."},
};

const Entry& entry(Reason reason) {
  for (const Entry& candidate : kEntries) {
    if (candidate.reason == reason) return candidate;
  }
  return kEntries[0];
}

}  // namespace

const char* code(Reason reason) { return entry(reason).code; }
const char* sentence(Reason reason) { return entry(reason).sentence; }

}  // namespace volcomp
