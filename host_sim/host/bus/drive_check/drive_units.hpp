#pragma once
// How a drive counts positions, from 608Fh, 6091h, 6092h and 60A8h (CiA 402-2, "factor group").

#include <cstdint>
#include <optional>
#include <string>

#include "host_sim/host/bus/drive_check/foreign_drive.hpp"

namespace volcomp::host {

struct DriveUnits {
  // Units in one turn of the axis, or of the motor where no gear is told; nothing: not known.
  std::optional<double> per_turn;
  std::optional<std::uint64_t> whole_per_turn;  // where that is a whole number
  std::optional<double> nm_per_unit;            // where the drive counts in parts of a metre
  // 2030h : 2031h of the node, the smallest fraction; nothing: each may be at most 2^20.
  std::optional<std::pair<std::uint32_t, std::uint32_t>> scale;
  std::string told_by;  // the objects and what they hold
  std::string unknown;  // why nothing is known, a sentence

  // Of a linear axis that goes `feed_mm` (1e-3…1e3) in a turn.
  void become_linear(double feed_mm);
  // A whole number of units in a turn that divides 2^32: the turn survives the wrap of an
  // INTEGER32.
  [[nodiscard]] bool survives_wrap() const;
  // A rotary axis that 2036h of the node describes.
  [[nodiscard]] bool fits_units_per_turn() const;
};

[[nodiscard]] DriveUnits units_of(const ForeignDrive& drive);

// "8192 per turn".
[[nodiscard]] std::string describe(const DriveUnits& units);
// A sentence where a unit is more than 0.1 um or 1 urad; else empty.
[[nodiscard]] std::string coarseness(const DriveUnits& units);

}  // namespace volcomp::host
