#pragma once
// What a controller commanded and what its encoders read while a helical gear was ground, cycle by
// cycle: a table (CSV) or recorded CAN traffic. docs/formats.md, "Strokes of a grinder".

#include <cstdint>
#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// mm, rad (counted through, not from turn to turn).
struct LoggedAxis {
  double command = 0.0;  // the controller's own, without an offset of a compensation
  double actual = 0.0;   // of the encoder at the same instant
};

struct StrokeSample {
  double time_s = 0.0;
  LoggedAxis x;
  LoggedAxis z;
  LoggedAxis c;
  std::optional<std::uint16_t> slot;  // where the log says so
  std::size_t line = 0;
};

struct StrokeLog {
  std::string name;
  double period_s = 0.0;  // of the cycle
  bool has_x = false;
  std::vector<StrokeSample> samples;  // in the order of time
};

inline constexpr std::size_t kMostStrokeSamples = 5'000'000;

// Columns "t [s]" (or [ms], [us]), "Z command [mm]", "Z actual [mm]", "C command [deg]",
// "C actual [deg]", in any order and any unit of their kind; and, where there are, both of X, and
// "slot". All throw UserError naming file, line and column.
[[nodiscard]] StrokeLog read_stroke_table(std::istream& stream, const std::string& name);

// As `candump -L` writes it, of the bus that the machine file describes: targets of the controller,
// positions of the drives, and the slot where the controller sends it to a node.
[[nodiscard]] StrokeLog read_stroke_frames(std::istream& stream, const std::string& name,
                                           const MachineFile& machine);

// Sets the period: the median of the steps of time, so that gaps do not count. Two samples or more.
// Throws UserError where it is the cycle of no controller, 10 µs to 0.1 s.
void set_period(StrokeLog& log);

// What the machine grinds. Throws UserError where its file does not say.
[[nodiscard]] const GrindingFile& grinding_of(const MachineFile& machine);

// The one or the other: the line of a frame begins with a parenthesis.
[[nodiscard]] StrokeLog read_stroke_log(const std::filesystem::path& path,
                                        const MachineFile& machine);

}  // namespace volcomp::host
