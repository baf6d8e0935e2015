#pragma once
// Behaviour in motion: a straight line, a circle, and the accuracy of the tick itself.

#include "host_sim/experiments/xyfz/scenario.hpp"

namespace volcomp::xyfz {

inline constexpr double kLineFeed_m_min = 10.0;
inline constexpr double kCircleFeed_m_min = 1.0;
inline constexpr double kCircleRadius_mm = 100.0;

// With and without the compensation of `closed`, noise-free.
[[nodiscard]] Dynamics run_dynamics(const sim::TrueMachine& truth, const host::MachineFile& machine,
                                    const host::BuiltTables& closed,
                                    const sim::CellFactory& make_cell);

// Integer tick against the same first-order model in double at random integer positions, inside the
// tables, at their knots and ends, and beyond; nm.
[[nodiscard]] double measure_tick_error_nm(const host::BuiltTables& closed, int points,
                                           std::uint64_t seed);

}  // namespace volcomp::xyfz
