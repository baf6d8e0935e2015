#pragma once
// The run-time models in double: tables, chain and squareness together. Used to build, verify and
// explain what the tick computes in float.

#include <array>

#include "comp/metrology/tables/error_table.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "comp/tables/thermal.hpp"

namespace volcomp {

// What happens beyond the end of a table: the error is held either way; the lever arms use the
// position as given, or the axis is treated as standing at the end (what the tick does).
enum class Beyond : std::uint8_t { lever_as_given, stand_at_end };

using Travels = std::array<Travel, kMaxAxes>;
inline constexpr Travels kUnknownTravels{};

// Borrows its tables: they must outlive it.
struct VolumetricModel {
  MachineChain chain;
  std::array<const ErrorTable*, kMaxAxes>
      table{};  // internal convention, by NC axis; null = no error
  DirectionErrors directions = zero_directions();  // squareness
  Expansions expansion{};
  Strains strain{};  // of the axes as warm as they are: strains()
  Vec3 tool_point = Vec3::Zero();

  [[nodiscard]] ErrorSet errors(const Pose& q, const Travels& travels) const;
  [[nodiscard]] Pose held(
      const Pose& q) const;  // every axis moved to the nearest place in its table

  // First-order sum (prismatic machines) or second-order recursion (any rotary axis): base frame,
  // mm.
  [[nodiscard]] Vec3 first_order(const Pose& q, const Travels& travels, Beyond beyond) const;
  [[nodiscard]] Vec3 second_order(const Pose& q, const Travels& travels, Beyond beyond) const;
};

// Converts a table as measured or stored to the internal convention, knot by knot (the only place
// where that happens).
void convert_to_internal(const Joint& joint, Convention convention, Side side, ErrorTable& table);

// How far the first-order run-time model can be from the exact chain, worst case over a grid of
// `steps` points per axis between the ends of the tables, in mm. Uses the rxryrz model in the work
// frame.
[[nodiscard]] double first_order_distance(const VolumetricModel& model, int steps);

}  // namespace volcomp
