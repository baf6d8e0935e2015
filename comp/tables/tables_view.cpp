#include "comp/tables/tables_view.hpp"

#include <cmath>

#include "comp/core/bytes.hpp"

namespace volcomp {

Channels AxisTableView::row(std::size_t travel, std::size_t knot) const {
  if (table_ != nullptr) return table_->value[travel][knot];
  Channels row{};
  const std::uint8_t* const at = bytes_ + sizeof row * (travel * grid_.knots + knot);
  for (std::size_t c = 0; c < row.size(); ++c)
    row[c] = load_f32(at + sizeof(float) * c);
  return row;
}

Status view_tables(const MachineTables& tables, TablesView& out) {
  if (const Status s = MachineChain::build(tables.machine, out.chain); !s.ok()) return s;
  out.provenance = tables.provenance;
  out.directions = tables.directions;
  out.expansion = tables.expansion;
  out.strain = {};
  if (const Status s = check_validity(tables.provenance); !s.ok()) return s;
  for (std::size_t a = 0; a < out.chain.axis_count(); ++a) {
    const Status s = check_expansion(tables.expansion[a], out.chain.axis(a));
    if (!s.ok()) return s;
    out.axis[a] = tables.axis[a];
  }
  return {};
}

Status check_values(const AxisTableView& table, const Joint& joint) {
  Where where;
  where.axis = joint.letter;
  for (std::size_t travel = 0; travel < 2; ++travel) {
    for (std::uint32_t i = 0; i < table.grid().knots; ++i) {
      const Channels row = table.row(travel, i);
      for (std::size_t c = 0; c < row.size(); ++c) {
        if (std::isfinite(row[c])) continue;
        where.index = static_cast<int>(i);
        where.channel = static_cast<int>(c);
        return refuse(Reason::not_finite, where);
      }
    }
  }
  return {};
}

}  // namespace volcomp
