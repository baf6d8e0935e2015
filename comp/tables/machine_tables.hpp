#pragma once
// Everything the run time needs to know of one commissioned machine: description, squareness and
// one float table per axis in kernel units (nm, rad; positions in nm or 2^-40 turn). Internal
// convention: body values, moving side.

#include <array>
#include <cstdint>

#include "comp/machine/machine_chain.hpp"
#include "comp/tables/thermal.hpp"

namespace volcomp {

// Storage for tables during commissioning; a board with little memory defines it smaller. What a
// run-time build accepts is its own, smaller capacity.
#ifdef VOLCOMP_TABLE_KNOTS
inline constexpr std::size_t kTableKnots = VOLCOMP_TABLE_KNOTS;
#else
inline constexpr std::size_t kTableKnots = 512;
#endif

using Channels = std::array<float, 6>;

// Where the knots of one axis lie.
struct TableGrid {
  std::int64_t q0 = 0;      // first knot
  std::int64_t pitch = 1;   // > 0
  std::uint32_t knots = 0;  // periodic: knots per turn, the first is not repeated
  bool periodic = false;    // rotary axis with a table over the full turn

  [[nodiscard]] std::int64_t last() const {
    return q0 + pitch * static_cast<std::int64_t>(knots - 1);
  }
};

struct AxisTable : TableGrid {
  std::array<std::array<Channels, kTableKnots>, 2> value{};  // [0] forward, [1] backward
};

struct Provenance {
  std::uint32_t machine_id = 0;
  std::uint32_t sequence = 0;
  std::int64_t built_unix_s = 0;
  std::int64_t expires_unix_s = 0;  // 0: never
  float temperature_C = 20.0F;      // of the campaign: reference of the expansions
  std::array<char, 16> stamp{};     // operator or tool that built it, zero-padded
};

struct MachineTables {
  Provenance provenance{};
  MachineDescription machine{};
  DirectionErrors directions = zero_directions();  // squareness, rad, by NC axis
  Expansions expansion{};
  std::array<AxisTable, kMaxAxes> axis{};
};

// What the run-time lookup can hold. Refuses too_few_knots, too_many_knots (> capacity),
// pitch_not_positive (below 1 nm or 2^-32 turn), travel_too_long (≥ 2^32 nm, or a whole turn that
// is not periodic), not_periodic.
Status check_knots(const TableGrid& table, const Joint& joint, std::size_t capacity);

// Smallest pitch and longest travel of a table, in its units: what 32 bits of the lookup can hold.
[[nodiscard]] std::int64_t least_pitch(const Joint& joint);
[[nodiscard]] std::int64_t longest_travel(const Joint& joint, bool periodic);

}  // namespace volcomp
