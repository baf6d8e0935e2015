#pragma once
// Raw runs of a case of docs/papers/xyfz.md, for the kinds that build tables.

#include <memory>

#include "comp/metrology/tables/table_builder.hpp"
#include "tests/cases/case_file.hpp"

namespace volcomp::cases {

// Owns what a MeasuredAxis borrows.
struct TableCase {
  explicit TableCase(const json& in);
  TableCase(const TableCase&) = delete;
  TableCase& operator=(const TableCase&) = delete;

  std::vector<double> positions;
  std::vector<std::vector<ErrorMotion>> up_values;
  std::vector<std::vector<ErrorMotion>> down_values;
  std::vector<Run> up;
  std::vector<Run> down;
  MeasuredAxis measured;
  std::unique_ptr<BuiltTable> built = std::make_unique<BuiltTable>();
};

// fwd, bwd, mean of a built table.
[[nodiscard]] json table_values(const ErrorTable& table);

}  // namespace volcomp::cases
