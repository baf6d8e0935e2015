#pragma once
// The internal helical gear grinder of Fu, Wang and Jiang (docs/papers/internal-helical.md): X
// carries C and the gear, Z carries the swivel A and the wheel; a Y slide, which the text of the
// paper names and its Table 1 leaves out, can stand on either side of Z.
//
// Gear frame: Z along the axis of the gear. At X = x > 0 the wheel stands at (−x, 0, Z), so the
// space under the wheel is centred on −X. The axis of the wheel is Y of the tool frame, turned by A
// about X.

#include "comp/machine/machine_chain.hpp"

namespace volcomp {

// NC axes of internal_grinder(); kGrinderY only with a Y slide.
inline constexpr std::size_t kGrinderX = 0;
inline constexpr std::size_t kGrinderZ = 1;
inline constexpr std::size_t kGrinderC = 2;
inline constexpr std::size_t kGrinderA = 3;
inline constexpr std::size_t kGrinderY = 4;

enum class GrinderY : std::uint8_t { none, on_z, under_z };

// Where each joint sits on the body that carries it, at machine zero, mm. All zero, as the paper
// has them, gives angular errors the shortest levers possible.
struct InternalGrinderOffsets {
  std::array<double, 3> x{};
  std::array<double, 3> c{};
  std::array<double, 3> y{};
  std::array<double, 3> z{};
  std::array<double, 3> a{};
};

// Bodies 1 bed, 2 X, 3 C, 4 gear, then Z, (Y,) A, wheel. Error motions are body values on the
// moving side. C corrects the synchronism of Z and C, X the width of the space.
[[nodiscard]] MachineDescription internal_grinder(GrinderY y,
                                                  const InternalGrinderOffsets& offsets = {});

// Where the machine stands at a stroke position of the wheel.
[[nodiscard]] Pose grinder_pose(double x, double z, double c, double a);

}  // namespace volcomp
