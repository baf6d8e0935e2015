#pragma once
// The machines whose worst tick is looked for, and tables for them that are the same on every
// board and computer.

#include <memory>

#include "comp/tables/machine_tables.hpp"
#include "tests/target/ticks/machines.hpp"

namespace volcomp::target {

// Five axes whose A and C hold the direction of the tool.
[[nodiscard]] MachineDescription orienting_five_axis();

// Five axes, every joint built in askew.
[[nodiscard]] MachineDescription askew_five_axis();

// The same with two fixed bodies that have errors: below the tool and below the workpiece.
[[nodiscard]] MachineDescription askew_five_axis_with_fixed_bodies();

// X, Y, Z, A, B on the tool side, C, U, V on the side of the workpiece; X, Y, Z correct.
[[nodiscard]] MachineDescription eight_axis();

// Two sets of tables with other values everywhere. The first rotary axis is not periodic, so that
// it can leave its table.
struct TwoTables {
  std::unique_ptr<MachineTables> one, other;
};
[[nodiscard]] TwoTables make_worst_tables(const MachineDescription& machine);

}  // namespace volcomp::target
