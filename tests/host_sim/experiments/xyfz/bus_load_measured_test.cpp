// The bus load that was measured, against the bounds that are computed.

#include "host_sim/experiments/xyfz/bus_load_measured.hpp"

#include <gtest/gtest.h>

namespace volcomp::xyfz {
namespace {

TEST(BusLoad, MeasuredLiesBetweenTheComputedBoundsAndInTime) {
  for (const host::BusLoadRow& row : host::bus_load_table({3}, measure_bus_load)) {
    SCOPED_TRACE(row.cycle_hz);
    EXPECT_EQ(row.measured.has_value(), row.cycle_hz < 600.0);
    if (!row.measured) continue;
    EXPECT_GT(row.measured->average, row.computed.nominal);
    EXPECT_LT(row.measured->average, row.computed.worst);
    EXPECT_TRUE(row.measured->in_time());
    EXPECT_LT(row.measured->worst_offset_us, 1e6 / row.cycle_hz);
    EXPECT_GT(static_cast<double>(row.measured->cycles), 2.0 * row.cycle_hz);
  }
}

}  // namespace
}  // namespace volcomp::xyfz
