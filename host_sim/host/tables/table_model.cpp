#include "host_sim/host/tables/table_model.hpp"

#include <utility>

#include <fmt/format.h>

#include "comp/metrology/tables/quantise.hpp"
#include "comp/tables/image.hpp"
#include "comp/tables/table_set.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

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

// With room for any machine and any table.
void require_foldable(const MachineTables& tables, const std::string& name) {
  const auto view = std::make_unique<TablesView>();
  require(view_tables(tables, *view), name);
  const RuntimeChain chain = make_runtime_chain(tables.machine);
  const auto set = std::make_unique<TableSet<kMaxAxes, kTableKnots>>();
  FoldReport report;
  require(fold_tables(*view, chain, view->chain.tool_point(), TableSetView(*set), report), name);
}

// The id is typed by a person, so an equal one does not prove that the machine is the same.
void require_same_machine(const MachineTables& tables, const std::string& image,
                          const MachineFile& machine) {
  if (tables.provenance.machine_id != machine.id)
    throw UserError(fmt::format("{}: tables of machine {}, {} describes machine {}", image,
                                tables.provenance.machine_id, machine.path, machine.id));
  if (!same_chain(make_runtime_chain(tables.machine),
                  make_runtime_chain(machine.chain.description())))
    throw UserError(fmt::format(
        "{}: tables of another chain of bodies than {} describes: axes, senses, offsets or what "
        "corrects differ",
        image, machine.path));
}

TableImage read_table_image(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_image_file(path);
  const Span<const std::uint8_t> span(bytes.data(), bytes.size());
  TableImage image{shown_name(path), bytes.size(), image_crc(span),
                   std::make_unique<MachineTables>()};
  require(decode_image(span, kTableKnots, *image.tables), image.name);
  return image;
}

std::unique_ptr<MachineTables> read_tables_file(const std::filesystem::path& path) {
  TableImage image = read_table_image(path);
  require_foldable(*image.tables, image.name);
  return std::move(image.tables);
}

}  // namespace volcomp::host
