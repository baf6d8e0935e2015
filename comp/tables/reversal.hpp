#pragma once
// What reversals do to the offsets of the axes whose direction follows them. An axis that is moved
// by its own change of direction, against its motion, or by that of another would take that for a
// reversal of its own and turn back and forth for ever, unless its hysteresis is as wide.

#include "comp/tables/table_set.hpp"

namespace volcomp {

// Sets report.reversal_nm: over all correcting axes the largest changes at a knot, their angles on
// the levers that the travel offers, through the rows of J⁻¹. Expects a folded set.
void measure_reversals(const TablesView& tables, const RuntimeChain& chain, const TableSetView& set,
                       FoldReport& report);

}  // namespace volcomp
