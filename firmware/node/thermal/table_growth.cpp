#include "firmware/node/thermal/table_growth.hpp"

#include <algorithm>

namespace volcomp::node {

bool past_expiry(const TablesView& tables, const NodeObjects& objects) {
  return expired(tables.provenance.expires_unix_s, objects.thermal.unix_s);
}

Strains strains_now(const TablesView& tables, const NodeObjects& objects) {
  return strains(tables, objects.thermal.believed);
}

void note_growth(const TablesView& tables, NodeObjects& objects) {
  ThermalObjects& thermal = objects.thermal;
  // The wire has 32 bits, enough until 2106.
  thermal.expires_unix_s = static_cast<std::uint32_t>(
      std::min<std::int64_t>(tables.provenance.expires_unix_s, UINT32_MAX));
  thermal.inputs = 0;
  for (const AxisExpansion& e : tables.expansion) {
    const bool grows = e.per_K < 0.0F || e.per_K > 0.0F;
    if (grows && e.input < kTemperatureInputs) thermal.inputs |= 1U << e.input;
  }
}

}  // namespace volcomp::node
