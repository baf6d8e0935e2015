#pragma once
// Probes with the node: announces the feature, moves, and reads the point that the node has made of
// the touch. It uses only data from the bus.

#include <vector>

#include "host_sim/sim/controller/bus_axes.hpp"
#include "host_sim/sim/controller/node_probe.hpp"

namespace volcomp::sim {

struct ProbingFeeds {
  double rapid = 50.0;    // mm/s, on the way to a touch
  double probing = 5.0;   // mm/s, or rad/s where only rotary axes move
  double retract = 0.05;  // the same, back from a touch
};

class Prober {
 public:
  // `axes` are those of the cell; both must outlive the prober.
  Prober(MotionCell& cell, BusAxes& axes, const host::MachineFile& machine)
      : cell_(cell), axes_(axes), machine_(machine) {}

  // The node's settings from now on, also after it was away.
  void configure(const host::NodeProbe& probe);

  // Goes to `from`, then towards `beyond` until the probe touches, then back. `normal`: of the part
  // at the contact, in the workpiece frame, or zero: the point is the centre of the ball. Throws
  // UserError when nothing was touched or the node rejected it, with its reason and number.
  NodePoint touch(const Pose& from, const Pose& beyond, const Vec3& normal,
                  const ProbingFeeds& feeds);

  // The same for a touch on a flank of the gear the node was configured with: `flank` of the point
  // is the node's judgement, the point itself the centre of the ball.
  NodePoint touch(const Pose& from, const Pose& beyond, const FlankFeature& flank,
                  const ProbingFeeds& feeds);

  // Points since the last call, oldest first, rejected ones included; releases them in the node.
  [[nodiscard]] std::vector<NodePoint> take_points();

 private:
  void announce(const Vec3& normal, const FlankFeature& flank);
  NodePoint touch_announced(const Pose& from, const Pose& beyond, const ProbingFeeds& feeds);
  void finish_transfers();
  [[nodiscard]] NodePoint only_good(const std::vector<NodePoint>& points) const;

  MotionCell& cell_;
  BusAxes& axes_;
  const host::MachineFile& machine_;
  std::uint16_t feature_ = 0;
  Vec3 normal_ = Vec3::Zero();  // that the node knows
  FlankFeature flank_{};        // likewise
};

}  // namespace volcomp::sim
