#pragma once
// Tables of the errors that a simulated machine really has at the targets of its file, for tests of
// what a node does with tables: how they were found does not matter to them.

#include <vector>

#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

[[nodiscard]] inline MachineTables true_tables(const TrueMachine& truth,
                                               const host::MachineFile& file) {
  std::vector<ErrorTable> tables;
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    ErrorTable table;
    table.q0 = file.axes[a].lo;
    table.knots = file.axes[a].targets;
    table.pitch = (file.axes[a].hi - table.q0) / static_cast<double>(table.knots - 1);
    for (std::size_t i = 0; i < table.knots; ++i) {
      Pose pose{};
      pose.at(a) = table.knot(i);
      table.forward.at(i) = table.backward.at(i) = truth.errors(pose, {}).at(a);
    }
    tables.push_back(table);
  }
  return host::tables_of_errors(file, tables)->tables;
}

[[nodiscard]] inline MachineTables no_tables(const host::MachineFile& file) {
  return host::constant_tables(file, zero_errors())->tables;
}

}  // namespace volcomp::sim
