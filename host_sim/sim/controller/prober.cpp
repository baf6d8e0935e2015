#include "host_sim/sim/controller/prober.hpp"

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::sim {
namespace {

// Periods; a setting takes one to ten.
constexpr int kLongestTransfer = 5000;

}  // namespace

// Time passes on the bus only while the axes are moved, or held.
void Prober::finish_transfers() {
  const host::SdoChannel& node = axes_.controller().node_objects();
  const bool done = cell_.hold([&node] { return node.idle(); }, kLongestTransfer);
  if (!done) throw host::UserError("the node does not answer about its probe");
  if (!node.failure().empty()) throw host::UserError(node.failure());
}

void Prober::configure(const host::NodeProbe& probe) {
  axes_.controller().use_probe(probe);
  finish_transfers();
}

// Only what is new: the bus is busy enough.
void Prober::announce(const Vec3& normal, const FlankFeature& flank) {
  host::SdoChannel& node = axes_.controller().node_objects();
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (normal(k) < normal_(k) || normal(k) > normal_(k))
      node.write_value(volcomp::node::object::probe::normal[static_cast<std::size_t>(k)].id(),
                       normal(k), "normal");
  }
  normal_ = normal;
  queue_flank(node, flank, flank_);
  flank_ = flank;
  node.write(volcomp::node::object::probe::feature, ++feature_);
}

NodePoint Prober::touch(const Pose& from, const Pose& beyond, const Vec3& normal,
                        const ProbingFeeds& feeds) {
  announce(normal, {});
  return touch_announced(from, beyond, feeds);
}

NodePoint Prober::touch(const Pose& from, const Pose& beyond, const FlankFeature& flank,
                        const ProbingFeeds& feeds) {
  announce(normal_, flank);
  NodePoint point = touch_announced(from, beyond, feeds);
  queue_judgement(axes_.controller().node_objects(), point.flank);
  finish_transfers();
  if (point.flank.sequence != point.sequence)
    throw host::UserError(fmt::format("touch {}: the node has not judged it", point.sequence));
  return point;
}

NodePoint Prober::touch_announced(const Pose& from, const Pose& beyond, const ProbingFeeds& feeds) {
  cell_.move_to(from, feeds.rapid);
  finish_transfers();
  const Touch touch = cell_.probe_to(beyond, feeds.probing, from, feeds.retract);
  if (!touch.touched)
    throw host::UserError(fmt::format("feature {}: nothing was touched", feature_));
  NodePoint point = only_good(take_points());
  point.latched = touch.latch;
  return point;
}

std::vector<NodePoint> Prober::take_points() {
  host::SdoChannel& node = axes_.controller().node_objects();
  std::vector<NodePoint> points = axes_.controller().take_points();
  for (const NodePoint& point : points)
    node.write(volcomp::node::object::probe::release, point.sequence);
  finish_transfers();
  return points;
}

// A touch may leave rejected edges beside its point: contacts bounce.
NodePoint Prober::only_good(const std::vector<NodePoint>& points) const {
  const NodePoint* good = nullptr;
  for (const NodePoint& point : points) {
    if (!accepted(point.verdict)) continue;
    if (good != nullptr)
      throw host::UserError(fmt::format("touches {} and {}: two points of feature {}",
                                        good->sequence, point.sequence, feature_));
    good = &point;
  }
  if (good != nullptr && good->feature == feature_) return *good;
  if (points.empty())
    throw host::UserError(
        fmt::format("feature {}: the node has made no point of the touch", feature_));
  const NodePoint& rejected = points.front();
  const std::string axis =
      rejected.axis == 0 ? ""
                         : fmt::format(", axis {}", machine_.axes.at(rejected.axis - 1U).letter);
  throw host::UserError(fmt::format("touch {}{}: {} [{}]", rejected.sequence, axis,
                                    sentence(rejected.verdict), code(rejected.verdict)));
}

}  // namespace volcomp::sim
