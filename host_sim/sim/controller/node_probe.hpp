#pragma once
// The probe of the compensation node as the controller sees it: the flank that is touched next
// (2313h) and the points the node makes of touches (2401h, as process data).
//
// The records of 2410h hold more, but 192 bytes in a burst leave no room on the bus for heartbeats.

#include <cstdint>
#include <utility>
#include <vector>

#include "comp/core/status.hpp"
#include "comp/machine/machine_chain.hpp"
#include "comp/probe/probe_corrector.hpp"
#include "host_sim/host/bus/sdo_channel.hpp"

namespace volcomp::sim {

// A flank that is to be touched: 2313h. mm.
struct FlankFeature {
  std::uint32_t gear_id = 0;  // 0: none
  int side = 1;
  int slot = 0;
  std::size_t row = 0;  // of the measuring grid
  std::size_t column = 0;
  double ball_radius = 0.0;
  double gate = 0.0;
};

// The node's judgement of a touch on a flank: 2401h:0C to :0F.
struct FlankJudgement {
  std::int32_t distance_nm = 0;  // node::kNoDistance: none
  Reason verdict = Reason::bad_point;
  Reason foot = Reason::bad_point;
  std::uint32_t sequence = 0;  // of the point
};

// Writes what differs from `known`, the flank the node has.
void queue_flank(host::SdoChannel& node, const FlankFeature& flank, const FlankFeature& known);
// Reads the latest judgement.
void queue_judgement(host::SdoChannel& node, FlankJudgement& judgement);

// mm and rad.
struct NodePoint {
  std::uint32_t sequence = 0;
  std::uint16_t feature = 0;  // low half
  TouchVerdict verdict = TouchVerdict::point;
  std::uint8_t axis = 0;  // NC axis the verdict is about, from 1; 0: none in particular
  Vec3 workpiece = Vec3::Zero();
  double uncertainty = 0.0;  // standard, largest of the coordinates
  Pose latched{};            // as the drives reported, uncorrected
  FlankJudgement flank{};    // where a flank was announced
};

// Puts the three process data of a point together.
class PointReader {
 public:
  // `number`, from 0: of the process data object.
  void take(std::size_t number, const hal::CanFrame& frame);
  // Those that have come since the last call, in their order.
  [[nodiscard]] std::vector<NodePoint> take_points() { return std::exchange(points_, {}); }

 private:
  NodePoint next_{};
  std::vector<NodePoint> points_;
};

}  // namespace volcomp::sim
