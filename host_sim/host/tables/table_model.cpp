#include "host_sim/host/tables/table_model.hpp"

#include "comp/metrology/tables/quantise.hpp"
#include "comp/tables/image.hpp"
#include "comp/tables/table_set.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// A node takes tables over by folding them, which bounds what they can ask for. Done here with room
// for any machine and any table.
void require_foldable(const MachineTables& tables, const std::string& name) {
  const auto view = std::make_unique<TablesView>();
  require(view_tables(tables, *view), name);
  const RuntimeChain chain = make_runtime_chain(tables.machine);
  const auto set = std::make_unique<TableSet<kMaxAxes, kTableKnots>>();
  FoldReport report;
  require(fold_tables(*view, chain, view->chain.tool_point(), TableSetView(*set), report), name);
}

}  // namespace

TableModel table_model(const MachineTables& tables, const std::string& name) {
  TableModel out;
  require(MachineChain::build(tables.machine, out.model.chain), name);
  out.model.tool_point = out.model.chain.tool_point();
  out.model.directions = tables.directions;
  for (std::size_t a = 0; a < out.model.chain.axis_count(); ++a) {
    out.tables.push_back(std::make_unique<ErrorTable>());
    dequantise(tables.axis[a], out.model.chain.axis(a), *out.tables.back());
    out.model.table[a] = out.tables.back().get();
  }
  return out;
}

std::unique_ptr<MachineTables> read_tables_file(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> image = read_image_file(path);
  auto tables = std::make_unique<MachineTables>();
  require(decode_image({image.data(), image.size()}, kTableKnots, *tables), shown_name(path));
  require_foldable(*tables, shown_name(path));
  return tables;
}

}  // namespace volcomp::host
