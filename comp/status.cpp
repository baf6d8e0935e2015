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

constexpr std::array<Entry, 40> kEntries{
    Entry{Reason::ok, "ok", "Accepted."},
    Entry{Reason::not_finite, "not_finite", "A value is NaN or infinite."},
    Entry{Reason::missing_field, "missing_field",
          "A mandatory field is absent; there is no default for it."},
    Entry{Reason::no_runs, "no_runs", "There is no run in either direction."},
    Entry{Reason::run_length, "run_length",
          "A run has another number of readings than there are targets."},
    Entry{Reason::too_many_runs, "too_many_runs", "There are more than 100 runs in one direction."},
    Entry{Reason::positions_not_monotone, "positions_not_monotone",
          "The target positions are not in order."},
    Entry{Reason::positions_duplicate, "positions_duplicate", "A target position occurs twice."},
    Entry{Reason::positions_not_uniform, "positions_not_uniform",
          "The target positions are not equally spaced and resampling was not allowed."},
    Entry{Reason::gap_too_large, "gap_too_large",
          "A gap between targets is more than twice the median spacing; resampling would invent "
          "data."},
    Entry{Reason::reference_out_of_range, "reference_out_of_range",
          "The reference knot lies outside the table."},
    Entry{Reason::unit_suspected, "unit_suspected",
          "The magnitude is implausible; micrometres, arc seconds, microradians or metres were "
          "probably "
          "given instead of mm and rad."},
    Entry{Reason::too_few_knots, "too_few_knots", "A table needs at least two knots."},
    Entry{Reason::too_many_knots, "too_many_knots",
          "The table has more knots than this build can hold."},
    Entry{Reason::pitch_not_positive, "pitch_not_positive",
          "The knot spacing must be at least one unit (1 nm)."},
    Entry{Reason::travel_too_long, "travel_too_long",
          "The table is longer than 4.29 m, the range of the run-time lookup."},
    Entry{Reason::not_periodic, "not_periodic",
          "A full-turn rotary table must start and end with the same values."},
    Entry{Reason::bad_magic, "bad_magic", "This is not a volcomp table image."},
    Entry{Reason::version_unknown, "version_unknown",
          "The image was written in a format version this build does not read."},
    Entry{Reason::image_truncated, "image_truncated",
          "The image is shorter or longer than its header says."},
    Entry{Reason::crc_mismatch, "crc_mismatch", "The checksum is wrong; the image is damaged."},
    Entry{Reason::machine_mismatch, "machine_mismatch", "The image was built for another machine."},
    Entry{Reason::axes_mismatch, "axes_mismatch",
          "The tables do not match the axes of the machine."},
    Entry{Reason::bound_exceeded, "bound_exceeded",
          "The corrections these tables can produce exceed what the tick can represent."},
    Entry{Reason::contraction_exceeded, "contraction_exceeded",
          "The errors change faster than 10 um per mm; tables like that are not plausible."},
    Entry{Reason::parent_not_lower, "parent_not_lower",
          "A body must be attached to a body with a lower number."},
    Entry{Reason::not_one_root, "not_one_root",
          "Exactly one body must be the root (lower body 0)."},
    Entry{Reason::bad_body, "bad_body", "The work or tool body does not exist."},
    Entry{Reason::too_many_bodies, "too_many_bodies",
          "The machine has more bodies than this build can hold."},
    Entry{Reason::too_many_axes, "too_many_axes", "The machine has more than eight axes."},
    Entry{Reason::bad_joint, "bad_joint",
          "A joint needs an axis X, Y or Z and a sign of +1 or -1."},
    Entry{Reason::not_a_rotation, "not_a_rotation",
          "The orientation of a fixed offset is not a rotation matrix."},
    Entry{Reason::bad_axis_index, "bad_axis_index",
          "The axis numbers must be 0, 1, 2 ... without gap or repetition."},
    Entry{Reason::no_authority, "no_authority",
          "The correcting axes cannot move the tool point in every direction here."},
    Entry{Reason::bad_setting, "bad_setting", "A setting is outside its range."},
    Entry{Reason::lever_mismatch, "lever_mismatch",
          "The lever self-test failed: sign, unit or order of the angles or arms is wrong."},
    Entry{Reason::lever_spread_too_small, "lever_spread_too_small",
          "The angles change too little for the lever self-test to mean anything."},
    Entry{Reason::too_few_points, "too_few_points",
          "There are too few points for this evaluation."},
    Entry{Reason::hand_over_pending, "hand_over_pending",
          "The tick has not yet taken over the tables handed to it before; try again."},
    Entry{Reason::not_staged, "not_staged", "There is no validated table set to activate."},
};

const Entry& entry(Reason reason) {
  static constexpr Entry kUnknown{Reason::ok, "unknown", "Unknown reason."};
  for (const Entry& candidate : kEntries) {
    if (candidate.reason == reason) return candidate;
  }
  return kUnknown;
}

}  // namespace

const char* code(Reason reason) { return entry(reason).code; }
const char* sentence(Reason reason) { return entry(reason).sentence; }

}  // namespace volcomp
