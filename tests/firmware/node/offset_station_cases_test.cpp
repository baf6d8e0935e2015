// The reference cases of the last check before a drive, bit for bit, on a computer and on boards.

#include "tests/cases/offset_case_numbers.hpp"
#include "tests/oracle/station_case.hpp"

namespace volcomp::test {
namespace {

void run_station(Numbers in) {
  const OffsetLimits limits = in.limits();
  StationCase station(limits, in.next());
  const std::int32_t ticks = in.next();
  const std::int32_t wanted_trip = in.next();
  std::int32_t tripped_at = -1;
  for (std::int32_t n = 0; n < ticks; ++n) {
    const std::int32_t sent = station.pass(in.next());
    ASSERT_EQ(sent, in.next()) << "tick " << n;
    if (tripped_at < 0 && station.tripped()) tripped_at = n;
  }
  ASSERT_EQ(tripped_at, wanted_trip);
}

TEST(OffsetCases, Station) { EXPECT_EQ(run_cases(Kind::station, run_station), 9); }

}  // namespace
}  // namespace volcomp::test
