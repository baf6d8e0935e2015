#pragma once
// What is measured of a machine before and after compensation: its diagonals, places all over its
// travel, a ball on its table.

#include <vector>

#include "host_sim/experiments/any_machine/sphere_test.hpp"
#include "host_sim/host/measure/volume_csv.hpp"

namespace volcomp::any_machine {

struct MachineState {
  std::vector<sim::MeasuredDiagonal> line;
  std::vector<PlaceReading> place;
  host::VolumeFigures volume;  // of the places, beside the best rigid motion; um
  std::vector<PlaceReading> sphere;

  [[nodiscard]] double lines_max_um() const;
  [[nodiscard]] host::VolumeFigures sphere_um() const;
  // Error of direction of the tool axis over places and ball, rad.
  [[nodiscard]] double tilt_max_rad() const;
  [[nodiscard]] double tilt_rms_rad() const;
  // The part of it that the orienting axes reach.
  [[nodiscard]] double steerable_max_rad() const;
};

// Where it is measured.
struct Verification {
  std::vector<sim::MeasuredLine> lines;
  std::vector<Pose> poses;
  SpherePlan sphere;
};
// `places` all over the travel, others for another seed.
[[nodiscard]] Verification plan_verification(const host::MachineFile& file, std::size_t places,
                                             std::uint64_t seed);

// With the tables of an image, or with none.
[[nodiscard]] MachineState verify_machine(const host::MachineFile& file,
                                          const sim::TrueMachine& truth, const Verification& plan,
                                          const sim::CellFactory& make_cell,
                                          const std::vector<std::uint8_t>& image);

}  // namespace volcomp::any_machine
