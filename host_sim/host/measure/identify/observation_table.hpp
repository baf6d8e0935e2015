#pragma once
// Observations as people write them: one row each, units in the header, columns in any order.
//
//   X [mm],Y [mm],Z [mm],tip,direction X,direction Y,direction Z,length [mm]
//
// Axis columns have the names of the machine file; direction is +, - or 0 (not known). What was
// read: length (tracer), radial (bar), displacement (diagonal, step), DX DY DZ (rtest); touches
// have none, but setup and sphere.

#include <filesystem>
#include <string>
#include <vector>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/measure/identify/problem.hpp"

namespace volcomp::host::identify {

struct TableRow {
  std::size_t line = 0;
  std::string setup;  // of touches
  std::size_t sphere = 0;
  std::string tip;  // empty: no such column
  Pose q{};         // mm, rad
  Directions d{};
  std::vector<double> value;  // mm
};

struct ObservationTable {
  std::string name;
  bool has_readings = false;  // else positions alone: a plan
  std::vector<TableRow> rows;
};

inline constexpr std::size_t kMostObservations = 200'000;

// Throws UserError with file and line: a column that is missing, unknown or there twice, a unit of
// another kind, a cell that is no finite number, no row, or too many. Whether a kind has readings
// is left to `has_readings`.
[[nodiscard]] ObservationTable read_observation_table(const std::filesystem::path& path,
                                                      const MachineFile& machine,
                                                      ObservationKind kind);
[[nodiscard]] ObservationTable read_observation_table(std::istream& stream, const std::string& name,
                                                      const MachineFile& machine,
                                                      ObservationKind kind);

}  // namespace volcomp::host::identify
