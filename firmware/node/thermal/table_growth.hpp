#pragma once
// Tables whose axes grow with temperature, and tables that expire; only where kFollowsTemperature.

#include "comp/tables/tables_view.hpp"
#include "firmware/node/node_objects.hpp"

namespace volcomp::node {

[[nodiscard]] bool past_expiry(const TablesView& tables, const NodeObjects& objects);
// For the temperatures in use (2701h).
[[nodiscard]] Strains strains_now(const TablesView& tables, const NodeObjects& objects);
// Writes inputs and expiry of tables that have been activated into the objects.
void note_growth(const TablesView& tables, NodeObjects& objects);

}  // namespace volcomp::node
