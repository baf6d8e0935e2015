#pragma once
// Units in the headers of measured data: "target [mm]".

#include <string_view>

#include "host_sim/host/io/csv_cells.hpp"

namespace volcomp::host {

struct CsvUnit {
  const char* name;
  double factor;  // to mm or rad
  bool angle;
};

// The unit in brackets of a header cell; `label` becomes what is before it. Fails at the current
// line when there is none or it is unknown.
[[nodiscard]] CsvUnit unit_of(const CsvLines& lines, std::string_view cell,
                              std::string_view& label);

// The same for a column that holds lengths.
[[nodiscard]] double length_unit(const CsvLines& lines, std::string_view cell,
                                 std::string_view& label);

}  // namespace volcomp::host
