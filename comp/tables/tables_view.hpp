#pragma once
// The tables of a machine as checking and folding read them, wherever the values are stored: as
// numbers in MachineTables, or still as the bytes of an image (check_image), so that a node needs
// no second copy. A view owns no value; it lives as long as what it was taken of, unchanged.

#include "comp/core/span.hpp"
#include "comp/tables/machine_tables.hpp"

namespace volcomp {

// One axis: its knots, and the six channels of any of them.
class AxisTableView {
 public:
  AxisTableView() = default;
  AxisTableView(const AxisTable& table)  // NOLINT(google-explicit-constructor)
      : grid_(static_cast<const TableGrid&>(table)), table_(&table) {}
  // `bytes`: little-endian f32[2][knots][6], forward then backward, as in an image.
  AxisTableView(const TableGrid& grid, const std::uint8_t* bytes) : grid_(grid), bytes_(bytes) {}

  [[nodiscard]] const TableGrid& grid() const { return grid_; }

  // nm and rad; travel 0 = forward, 1 = backward.
  [[nodiscard]] Channels row(std::size_t travel, std::size_t knot) const;

 private:
  TableGrid grid_{};
  const AxisTable* table_ = nullptr;     // either this
  const std::uint8_t* bytes_ = nullptr;  // or this
};

struct TablesView {
  Provenance provenance{};
  MachineChain chain{};
  DirectionErrors directions = zero_directions();
  Expansions expansion{};
  Strains strain{};  // of the axes as warm as they are; check_image() sets them to 0
  std::array<AxisTableView, kMaxAxes> axis{};
};

// Refuses what MachineChain::build, check_validity and check_expansion refuse; the tables
// themselves are not checked.
Status view_tables(const MachineTables& tables, TablesView& out);

// Refuses not_finite (where.index = knot, where.channel).
Status check_values(const AxisTableView& table, const Joint& joint);

}  // namespace volcomp
