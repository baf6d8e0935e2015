#pragma once
// Error maps of a flank as CSV.
//
// A map has the rows and columns of the paper's tables, an empty cell where nothing was measured:
//
//   row,c1,c2,…,c15
//   1,0.1,4.2,,…

#include <filesystem>
#include <istream>
#include <string>

#include "comp/metrology/faces/error_map.hpp"

namespace volcomp::host {

// Throws UserError with file, line, row and column: text that is no number, NaN or infinity, rows
// or columns that are missing, twice there or too many.
[[nodiscard]] ErrorMap read_map(std::istream& stream, const std::string& name);
[[nodiscard]] ErrorMap read_map_file(const std::filesystem::path& path);

// Four decimals.
[[nodiscard]] std::string map_csv(const ErrorMap& map);

}  // namespace volcomp::host
