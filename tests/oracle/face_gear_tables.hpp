#pragma once
// Tables 3 and 5 to 8 of the paper, read where the tests' data lie.

#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include "comp/metrology/faces/error_map.hpp"

namespace volcomp::reference {

// The rows of a table below its heading, without their first cell.
inline std::vector<std::vector<double>> numbers_of_table(const std::string& name) {
  std::ifstream stream(std::string(VOLCOMP_TESTS_DIR) + "/data/tables-002/" + name);
  EXPECT_TRUE(stream) << name;
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    rows.emplace_back();
    while (std::getline(cells, cell, ','))
      rows.back().push_back(std::stod(cell));
  }
  return rows;
}

inline ErrorMap map_of_table(const std::string& name) {
  std::vector<double> cells;
  for (const auto& row : numbers_of_table(name))
    cells.insert(cells.end(), row.begin(), row.end());
  ErrorMap map;
  EXPECT_TRUE(ErrorMap::from(cells, map).ok()) << name;
  return map;
}

// On-machine and gear-measuring-centre maps, µm, by flank: left, right.
struct PaperMaps {
  std::array<ErrorMap, 2> on_machine{map_of_table("table5_omm_left_um.csv"),
                                     map_of_table("table6_omm_right_um.csv")};
  std::array<ErrorMap, 2> measuring_centre{map_of_table("table7_gmc_left_um.csv"),
                                           map_of_table("table8_gmc_right_um.csv")};
};

}  // namespace volcomp::reference
