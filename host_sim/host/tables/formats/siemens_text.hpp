#pragma once
// The frame of Siemens compensation files: a header, assignments to system variables, M17.

#include <map>
#include <string>
#include <vector>

namespace volcomp::host {

// $NAME[index,…]=value, without the $; parentheses around the value are taken off.
struct SystemVariable {
  std::string name;
  std::vector<std::string> index;
  std::string value;
  int line = 0;
};

// Throws UserError with the line for anything else between `header`, CHANDATA(1) and M17.
[[nodiscard]] std::vector<SystemVariable> read_system_variables(const std::string& text,
                                                                const std::string& header);

// The entries of a table, which must be complete: 0, 1, 2, … without gap or repetition.
[[nodiscard]] std::vector<double> complete_entries(const std::map<long long, double>& entries,
                                                   const std::string& name);

// Whether six decimals hold both ends of a table.
[[nodiscard]] bool fits_extent(double min, double step, std::size_t entries);

// MIN, MAX and STEP of a table agree with its number of entries. Throws UserError.
void check_extent(double min, double max, double step, std::size_t entries);

}  // namespace volcomp::host
