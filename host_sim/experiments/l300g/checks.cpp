#include "host_sim/experiments/l300g/checks.hpp"

#include <algorithm>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/volumetric.hpp"

namespace volcomp::l300g {
namespace {

constexpr std::array<double, 5> kFeeds_mm_min{10.0, 30.0, 100.0, 300.0, 1000.0};
// At the fastest feed the axis has done with accelerating when it touches.
constexpr double kRunUp_mm = 0.5;

void from_mean(std::vector<double>& values) {
  double mean = 0.0;
  for (const double v : values)
    mean += v / static_cast<double>(values.size());
  for (double& v : values)
    v -= mean;
}

double spread(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

}  // namespace

double FeedCheck::raw_spread_nm() const { return spread(raw_nm); }
double FeedCheck::corrected_spread_nm() const { return spread(corrected_nm); }

FeedCheck check_feeds(Grinder& grinder, GearInspector& inspector, const InvoluteGear& gear) {
  const Flank flank{FlankSide::left, 0};
  const MachineChain& chain = grinder.chain();
  FeedCheck check;
  for (const double feed : kFeeds_mm_min) {
    const sim::NodePoint point =
        inspector.touch({flank, pitch_roll(gear), 0.5 * gear.width}, {feed / 60.0, kRunUp_mm});
    const Vec3 latched = ideal_points(chain, point.latched, chain.tool_point()).work;
    check.feed_mm_min.push_back(feed);
    check.raw_nm.push_back(kNmPerMm * inspector.distance(flank, latched).distance);
    check.corrected_nm.push_back(kNmPerMm * inspector.distance(flank, point.workpiece).distance);
  }
  inspector.retract();
  from_mean(check.raw_nm);
  from_mean(check.corrected_nm);
  return check;
}

}  // namespace volcomp::l300g
