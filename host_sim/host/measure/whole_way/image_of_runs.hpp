#pragma once
// Whether an image holds the tables that a machine file and runs make.

#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/host/tables/table_model.hpp"

namespace volcomp::host {

// Throws UserError naming the image and what differs: the machine, or a table, by how much.
// `built`: from the machine file and runs, with the settings of the image.
void require_image_of_runs(const TableImage& image, const MachineFile& machine,
                           const BuiltTables& built);

}  // namespace volcomp::host
