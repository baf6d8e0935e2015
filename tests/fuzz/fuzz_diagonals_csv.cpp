// Any bytes as a file of diagonals, of the volume or of a ball bar: accepted or refused with a
// UserError, and what is accepted is the same after writing and reading, compared with itself.

#include <sstream>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_csv.hpp"
#include "host_sim/host/measure/diagonal_csv.hpp"
#include "host_sim/host/measure/volume_csv.hpp"

using volcomp::host::UserError;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    std::istringstream stream(text);
    const auto file = volcomp::host::read_diagonals(stream, "diagonals.csv");
    for (const auto& d : file.diagonals) {
      for (const auto& run : d.runs) {
        if (run.deviation_mm.size() != d.targets.size()) __builtin_trap();
      }
    }
    volcomp::host::require_same_points(file, file);
  } catch (const UserError&) {
  }
  try {
    std::istringstream stream(text);
    const auto file = volcomp::host::read_volume(stream, "volume.csv");
    volcomp::host::require_same_places(file, file);
    static_cast<void>(volcomp::host::aligned_volume_figures(file.points));
  } catch (const UserError&) {
  }
  try {
    std::istringstream stream(text);
    const auto test = volcomp::host::read_ball_bar(stream, "ball_bar.csv");
    for (const auto& circles : test.circle) {
      for (const auto& circle : circles) {
        if (circle.theta.size() != circle.radial.size()) __builtin_trap();
      }
    }
    static_cast<void>(volcomp::host::ball_bar_csv(test));
  } catch (const UserError&) {
  }
  return 0;
}
