#include "host_sim/host/io/csv_units.hpp"

#include <array>

#include <fmt/format.h>

#include "comp/core/units.hpp"

namespace volcomp::host {
namespace {

constexpr std::array<CsvUnit, 10> kUnits{{{"mm", 1.0, false},
                                          {"um", 1e-3, false},
                                          {"\xC2\xB5m", 1e-3, false},
                                          {"nm", 1e-6, false},
                                          {"rad", 1.0, true},
                                          {"mrad", 1e-3, true},
                                          {"urad", 1e-6, true},
                                          {"\xC2\xB5rad", 1e-6, true},
                                          {"arcsec", kPi / 648000.0, true},
                                          {"deg", kPi / 180.0, true}}};

}  // namespace

CsvUnit unit_of(const CsvLines& lines, std::string_view cell, std::string_view& label) {
  const std::size_t open = cell.find('[');
  const std::size_t close = cell.find(']');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) {
    lines.fail(fmt::format("column {} needs its unit in brackets, for instance [um] or [urad]",
                           quoted(cell)));
  }
  label = trimmed(cell.substr(0, open));
  const std::string_view name = trimmed(cell.substr(open + 1, close - open - 1));
  for (const CsvUnit& unit : kUnits) {
    if (name == unit.name) return unit;
  }
  lines.fail(
      fmt::format("unknown unit {} (known: mm um nm rad mrad urad arcsec deg)", quoted(name)));
}

double length_unit(const CsvLines& lines, std::string_view cell, std::string_view& label) {
  const CsvUnit unit = unit_of(lines, cell, label);
  if (unit.angle) lines.fail(fmt::format("column {} has a unit of the wrong kind", quoted(cell)));
  return unit.factor;
}

}  // namespace volcomp::host
