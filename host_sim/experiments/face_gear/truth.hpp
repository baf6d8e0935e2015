#pragma once
// The face gear as it really is, and where it lies: the paper gives no pitch deviations, so they
// are chosen here (docs/papers/face-gear.md, "What stays open").

#include <array>
#include <cstdint>
#include <vector>

#include "comp/machine/frame.hpp"
#include "comp/metrology/faces/error_map.hpp"
#include "comp/metrology/faces/face_grid.hpp"
#include "host_sim/experiments/face_gear/inspection_plan.hpp"
#include "host_sim/sim/artefacts/face_gear.hpp"

namespace volcomp::face_gear {

enum class FormTruth : std::uint8_t {
  tables,     // of the paper's gear measuring centre (Tables 7 and 8)
  synthetic,  // a smooth form of 3 µm
};
inline constexpr std::array<const char*, 2> kFormTruths{"tables", "synthetic"};

// Errors of the gear. Left flank first; µm.
struct FaceGearErrors {
  std::array<ErrorMap, 2> form;              // of every slot
  std::array<std::vector<double>, 2> pitch;  // arc by which the flanks of a slot are displaced
};
[[nodiscard]] FaceGearErrors make_face_errors(const FaceGear& gear, FormTruth form,
                                              std::uint64_t seed);
// Between the points of the grid the form is interpolated.
[[nodiscard]] sim::FaceDeviation deviation_of(const FaceGearErrors& errors, const FaceGear& gear,
                                              const FaceGrid& grid);

// The gear frame in the work frame of the machine: Z points down into the table.
[[nodiscard]] Frame face_mounting(const Vec3& origin, double angle, const Vec3& tilt);
// The mounting of the clamping's drawing, and the true one.
[[nodiscard]] Frame nominal_mounting();
[[nodiscard]] Frame true_mounting();

}  // namespace volcomp::face_gear
