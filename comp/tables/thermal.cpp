#include "comp/tables/thermal.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/to_double.hpp"
#include "comp/core/units.hpp"
#include "comp/tables/tables_view.hpp"
#include "comp/tables/thermal_check.hpp"

namespace volcomp {

Strains strains(const Expansions& expansion, double reference_C, const Temperatures& temperature) {
  Strains strain{};
  for (std::size_t a = 0; a < kMaxAxes; ++a) {
    const AxisExpansion& e = expansion[a];
    if (e.input >= kTemperatureInputs || !std::isfinite(temperature[e.input])) continue;
    const double warmer_K = static_cast<double>(temperature[e.input]) - reference_C;
    strain[a] = static_cast<double>(e.per_K) * warmer_K;
  }
  return strain;
}

Strains strains(const TablesView& tables, const Temperatures& temperature) {
  const auto reference_C = static_cast<double>(tables.provenance.temperature_C);
  return strains(tables.expansion, reference_C, temperature);
}

Status check_expansion(const AxisExpansion& expansion, const Joint& joint) {
  Where where;
  where.axis = joint.letter;
  if (!usable_growth(expansion, joint)) where.field = "expansion";
  if (!usable_fixed_point(expansion)) where.field = "fixed point";
  if (!usable_input(expansion)) where.field = "temperature input";
  return where.field == nullptr ? Status{} : refuse(Reason::bad_thermal, where);
}

Status check_validity(const Provenance& provenance) {
  Where where;
  if (!is_temperature(provenance.temperature_C)) where.field = "reference temperature";
  if (!usable_expiry(provenance)) where.field = "expiry";
  return where.field == nullptr ? Status{} : refuse(Reason::bad_thermal, where);
}

double largest_growth_nm(const TablesView& tables, const Strains& strain) {
  double largest = 0.0;
  for (std::size_t a = 0; a < tables.chain.axis_count(); ++a) {
    const TableGrid& grid = tables.axis[a].grid();
    const double fixed = kNmPerMm * static_cast<double>(tables.expansion[a].fixed_mm);
    const double reach =
        std::max(std::abs(to_double(grid.q0) - fixed), std::abs(to_double(grid.last()) - fixed));
    largest = std::max(largest, std::abs(strain[a] - tables.strain[a]) * reach);
  }
  return largest;
}

}  // namespace volcomp
