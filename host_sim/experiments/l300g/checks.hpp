#pragma once
// Whether a point depends on how it was touched: on the feed, on the direction.

#include <vector>

#include "host_sim/experiments/l300g/inspection.hpp"

namespace volcomp::l300g {

// The same place of a flank, touched at 10, 30, 100, 300 and 1000 mm/min.
struct FeedCheck {
  std::vector<double> feed_mm_min;
  std::vector<double> raw_nm;        // normal to the flank, as latched; from the mean of all
  std::vector<double> corrected_nm;  // as the node reports

  [[nodiscard]] double raw_spread_nm() const;
  [[nodiscard]] double corrected_spread_nm() const;
};

[[nodiscard]] FeedCheck check_feeds(Grinder& grinder, GearInspector& inspector,
                                    const InvoluteGear& gear);

}  // namespace volcomp::l300g
