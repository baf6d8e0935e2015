#pragma once
// From tables in double to those of the run time, and back.

#include "comp/metrology/tables/error_table.hpp"
#include "comp/tables/machine_tables.hpp"

namespace volcomp {

// A rotary table whose ends are one turn apart (within 1e-9 rad): it wraps, in the tick and in the
// double model.
[[nodiscard]] bool is_full_turn(const ErrorTable& table, const Joint& joint);

// Quantises one table that is already in the internal convention: knots moved to whole units
// (values follow by linear interpolation), a full turn becomes periodic. Refuses what check_table
// refuses, pitch_not_positive (below one unit), travel_too_long (≥ 2^32 nm or more than
// one turn), not_periodic (full turn whose ends differ in either direction).
Status quantise(const ErrorTable& table, const Joint& joint, std::size_t capacity, AxisTable& out);

// The double table a quantised one stands for.
void dequantise(const AxisTable& table, const Joint& joint, ErrorTable& out);

}  // namespace volcomp
