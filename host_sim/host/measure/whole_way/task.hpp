#pragma once
// Where a machine works: the places whose uncertainty is asked for, in machine coordinates.

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "comp/machine/machine_chain.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

enum class TaskKind : std::uint8_t { point, line, places };

struct Task {
  std::string name;  // for messages
  TaskKind kind = TaskKind::places;
  std::vector<Pose> places;  // all axes, mm and rad
};

inline constexpr std::size_t kMostTaskPlaces = 1000;

// "X,Y,Z": one number for each axis in the order of the machine file, mm, degrees of rotary ones.
// All throw UserError: what is no number or too few of them, a place outside the travel.
[[nodiscard]] Task point_task(const std::string& point, const MachineFile& machine);
// "X,Y,Z:X,Y,Z": from end to end, `places` ≥ 2 of them equally spaced.
[[nodiscard]] Task line_task(const std::string& line, std::size_t places,
                             const MachineFile& machine);
// CSV with a column for each axis, "X [mm],Y [mm],Z [mm]" in any order, a row for each place.
[[nodiscard]] Task read_task(std::istream& stream, const std::string& name,
                             const MachineFile& machine);
[[nodiscard]] Task read_task_file(const std::filesystem::path& path, const MachineFile& machine);

// "X -250 mm, B 45 deg".
[[nodiscard]] std::string place_text(const Pose& place, const MachineFile& machine);

}  // namespace volcomp::host
