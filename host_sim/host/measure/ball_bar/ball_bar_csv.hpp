#pragma once
// A circular test as CSV. Facts first, one a line; of these the plane has no default, since the
// sign of the squareness depends on it:
//
//   # plane XY              from X towards Y; also YZ, ZX, YX, ZY, XZ
//   # radius_mm 100         nominal
//   # feed_mm_min 1000      with both directions
//   # centre_mm 0 0 -200    of the circle, NC coordinates; may be left out, like all that follow
//   # calibrated yes        the length of the bar is known: D means something
//   # temperature_C 21.5
//   # cyclic_mm 10 0        wavelengths looked for in the first and the second axis; 0: none
//   # run 2                 of what follows
//   angle [deg],radial [um],direction
//   0,1.2,ccw
//
// Angles are nominal ones of the path, from the first axis towards the second; `radial` is length
// of the bar minus nominal radius. Or, for one direction after the other, readings by number, from
// 0 on without a gap:
//
//   # direction cw
//   # start_deg 360
//   # step_deg 1            angle = start − index × step, + for ccw
//   index,radial [um]
//   0,1.2
//
// Instead of the step `# end_deg 0`, the angle of the last reading: a file that was cut off is then
// stretched. Facts stand before the first reading, but for run, direction, start, step and end.
// Other lines with # are comments. Of readings beyond a full turn the first turn counts.

#include <filesystem>
#include <istream>
#include <string>

#include "host_sim/host/measure/ball_bar/ball_bar_circles.hpp"

namespace volcomp::host {

// Throws UserError with file and line: malformed fact or number, a fact after a reading, unknown or
// missing column or unit, unknown direction, a reading by number that is not the next, more than
// 100 circles or 100 000 readings, and what check() refuses.
[[nodiscard]] BallBarTest read_ball_bar(std::istream& stream, const std::string& name);
[[nodiscard]] BallBarTest read_ball_bar_file(const std::filesystem::path& path);

// The same file, for programs that simulate a bar.
[[nodiscard]] std::string ball_bar_csv(const BallBarTest& test);

}  // namespace volcomp::host
