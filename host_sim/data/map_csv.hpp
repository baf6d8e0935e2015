#pragma once
// Error maps and nominal grids of a flank as CSV.
//
// A map has the rows and columns of the paper's tables, an empty cell where nothing was measured:
//
//   row,c1,c2,…,c15
//   1,0.1,4.2,,…
//
// A grid has a line for each of its 105 points, on side +1 of slot 0 in the frame of the gear, mm:
//
//   row,column,X,Y,Z
//   1,1,162.5,3.93,46.6

#include <array>
#include <filesystem>
#include <istream>
#include <string>

#include "comp/evaluation/error_map.hpp"

namespace volcomp::sim {

// Throws UserError with file, line, row and column: text that is no number, NaN or infinity, rows
// or columns that are missing, twice there or too many.
[[nodiscard]] ErrorMap read_map(std::istream& stream, const std::string& name);
[[nodiscard]] ErrorMap read_map_file(const std::filesystem::path& path);

using GridPoints = std::array<Vec3, kGridCells>;

// Likewise; here every point must be there.
[[nodiscard]] GridPoints read_grid(std::istream& stream, const std::string& name);
[[nodiscard]] GridPoints read_grid_file(const std::filesystem::path& path);

}  // namespace volcomp::sim
