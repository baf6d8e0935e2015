// Any bytes as a file of diagonals or of the volume: accepted or refused with a UserError, and what
// is accepted is the same after writing and reading, compared with itself.

#include <sstream>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/diagonal_csv.hpp"
#include "host_sim/host/measure/volume_csv.hpp"

using volcomp::sim::UserError;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    std::istringstream stream(text);
    const auto file = volcomp::sim::read_diagonals(stream, "diagonals.csv");
    for (const auto& d : file.diagonals) {
      for (const auto& run : d.runs) {
        if (run.deviation_mm.size() != d.targets.size()) __builtin_trap();
      }
    }
    volcomp::sim::require_same_points(file, file);
  } catch (const UserError&) {
  }
  try {
    std::istringstream stream(text);
    const auto file = volcomp::sim::read_volume(stream, "volume.csv");
    volcomp::sim::require_same_places(file, file);
    static_cast<void>(volcomp::sim::aligned_volume_figures(file.points));
  } catch (const UserError&) {
  }
  return 0;
}
