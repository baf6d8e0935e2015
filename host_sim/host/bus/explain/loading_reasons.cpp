// Reasons for which measured runs, machines, tables and settings are refused.

#include "host_sim/host/bus/explain/reason_rows.hpp"

namespace volcomp::host {

const std::vector<ReasonRow>& loading_reasons() {
  static const std::vector<ReasonRow> rows{
      {Reason::ok, "The input passed every check.", "Nothing."},
      {Reason::not_finite,
       "A division by zero, an empty cell that a spreadsheet filled in, or damaged bytes. One such "
       "value would reach a drive as an arbitrary offset.",
       "Look at the run, target and channel that are named, and measure or export them again."},
      {Reason::missing_field,
       "Convention, side, lever and kappa decide signs; a silent default would be wrong for half "
       "of all machines and cost 8 to 60 µm.",
       "Write the field. docs/conventions.md says with one drawing each what the values mean."},
      {Reason::no_runs, "The file holds targets but no readings for this axis.",
       "Measure at least one run; two directions and three runs or more are needed for reversal "
       "and repeatability."},
      {Reason::run_length, "A run was aborted, or a line is missing in the export.",
       "Complete the run or take it out; the others are enough if they are whole."},
      {Reason::too_many_runs, "Averaging works in memory of fixed size.",
       "Average runs beforehand, or build the tables from the latest ones."},
      {Reason::positions_not_monotone,
       "The targets rise and fall: both directions were put below one another, or lines were "
       "sorted by another column.",
       "Give every direction as runs of its own (columns run and direction) with targets in "
       "order."},
      {Reason::positions_duplicate,
       "A target was measured twice in one run, or is rounded so far that two became equal.",
       "Take one of them out, or write positions with more digits."},
      {Reason::positions_not_uniform,
       "The tick finds its knot by one multiplication and needs equal spacing; --no-resampling "
       "forbids moving the targets to a grid.",
       "Leave --no-resampling away, or measure at equal distances."},
      {Reason::gap_too_large,
       "A target was left out. Between its neighbours the error was not seen.",
       "Measure the missing targets."},
      {Reason::reference_out_of_range,
       "Tables are zero at their reference, and it must be among what was measured.",
       "Change reference_mm or reference_rad in the machine file, or measure farther."},
      {Reason::unit_suspected,
       "The header names a unit in which the values would be those of a broken machine: "
       "micrometres read as millimetres, arc seconds as microradians.",
       "Correct the unit in the header of the column."},
      {Reason::too_few_knots, "One point says nothing about what lies beside it.",
       "Measure at least two targets; eleven are usual (ISO 230-2)."},
      {Reason::too_many_knots,
       "The run time has room for a fixed number of knots per axis (128, on the M4F board 64).",
       "Build the tables with --knots of the node: they are refined less. It cannot be less than "
       "the number of targets; otherwise leave targets out of the runs."},
      {Reason::pitch_not_positive,
       "Knots fall together when they are rounded to the unit of the run time.",
       "Use fewer knots over this travel."},
      {Reason::travel_too_long,
       "Distances inside a table are 32-bit numbers of nanometres; a rotary table holds one turn.",
       "Split the travel, or declare a rotary axis over a whole turn as such."},
      {Reason::not_periodic,
       "A turn ends where it begins; a step there would be put out at every revolution.",
       "build-tables takes out what drifts up to 5 µm and 50 µrad between the ends; with more, "
       "measure 0 and 360 degrees again and look for what moves. A table from elsewhere must have "
       "the same values at both ends."},
      {Reason::bad_magic,
       "The first four bytes are not those of an image: another file, or one that was opened and "
       "saved as text.",
       "Give the file that build-tables wrote."},
      {Reason::version_unknown, "The image is from another version of volcomp.",
       "Build the tables again from the runs with the version that is installed."},
      {Reason::image_truncated, "A copy or a download was cut short, or something was appended.",
       "Copy it again; if its length is that of the file, build it again."},
      {Reason::crc_mismatch,
       "At least one bit is not what was written. The axis is named where its own checksum tells.",
       "Copy or download the image again. If it comes back, look for the memory or the medium."},
      {Reason::machine_mismatch,
       "The image carries the id of another machine, or its chain is not the one that is compiled "
       "in.",
       "Take the tables of this machine, or correct id in the machine file or 2000h:01 in the "
       "node."},
      {Reason::axes_mismatch,
       "Number, kind or order of the axes differ between tables and machine.",
       "Build the tables with the machine file that the controller uses."},
      {Reason::bound_exceeded,
       "Somewhere on the travel the corrections would exceed the range of their representation "
       "(4.19 mm, 6.1 mrad). Real machines are far below.",
       "Look for a wrong unit or lever in the machine file."},
      {Reason::contraction_exceeded,
       "The correction depends on where the axis stands and moves it; that settles only if errors "
       "change slowly along the travel.",
       "Look for outliers or a wrong unit in the runs, or use fewer knots."},
      {Reason::parent_not_lower, "Bodies are numbered from the bed outwards (lower-body array).",
       "List a body after the one it hangs on."},
      {Reason::not_one_root, "Two bodies hang on nothing, or none does.",
       "Leave 'on' away for the bed only."},
      {Reason::bad_body, "[tool] or [work] names a body that is not in the list.",
       "Use the name of one of the [[body]] tables."},
      {Reason::too_many_bodies, "A chain holds 16 bodies.",
       "Put fixed bodies together: offsets add up."},
      {Reason::too_many_axes,
       "A chain has eight axes; the node, the C interface and LinuxCNC, which load machines with "
       "their tables, serve five.",
       "Leave out axes that move neither tool nor workpiece."},
      {Reason::bad_joint, "A body moves along or about one of its own axes, forwards or backwards.",
       "Correct moves_along, turns_about or sign."},
      {Reason::not_a_rotation, "The nine numbers are not orthonormal, or mirror.",
       "Write them by rows with all their digits, or use zero_deg."},
      {Reason::bad_axis_index, "Two bodies are moved by the same NC axis, or an axis moves none.",
       "Give every axis exactly one body."},
      {Reason::no_authority,
       "Two correcting axes point (nearly) the same way here, or a swinging arm stands at its dead "
       "centre: a small error would need a huge motion.",
       "Declare other correcting axes, or keep away from this position; the last correction is "
       "held."},
      {Reason::bad_setting, "A limit, rate, ramp or delay is outside its range.",
       "Correct the setting that is named; the ones in force stay."},
      {Reason::lever_mismatch,
       "Straightness and positioning at two places differ by angle times lever. Here they do not, "
       "so a sign, a unit, the order of the angles or an arm is wrong.",
       "Compare convention, side, sensed_point_mm and kappa with the setup; docs/conventions.md."},
      {Reason::lever_spread_too_small, "The axis hardly pitches: every sign would pass the test.",
       "Take the two places farther apart, or trust the setup sheet."},
      {Reason::too_few_points,
       "A fit needs at least as many points as unknowns, and more to show an error.",
       "Measure more points."},
      {Reason::hand_over_pending,
       "Tables were handed over and the interrupt has not come since: the axis is not running.",
       "Start the tick (OPERATIONAL, SYNC), then repeat."},
      {Reason::not_staged, "2111h = 2 or 3 without tables that passed validation before.",
       "Download an image first and let it be validated."},
      {Reason::bad_thermal,
       "An axis grows by at most 1e-4 per K around a point within 5 m, rotary axes do not grow, "
       "inputs are 0 to 3, and the campaign was made between -20 and 80 deg C.",
       "Correct [thermal] of the machine file or the options of build-tables. docs/thermal.md."},
      {Reason::expired,
       "A machine changes; whoever built the tables said until when they hold. The date came with "
       "TIME or 2704h:01.",
       "Measure the machine again, or build the tables again with another --expires. A wrong date "
       "of the node shows in volcomp diagnose."},
      {Reason::cannot_orient,
       "With an axis named: it does not turn, corrects the position already or is named twice. "
       "Without: nodes of boards with little memory correct the position only.",
       "Leave the axis out of 'orienting' in [correction] of the machine file and build the tables "
       "again."},
  };
  return rows;
}

}  // namespace volcomp::host
