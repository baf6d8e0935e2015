#include "host_sim/sim/controller/node_probe.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "firmware/node/probe/probe_objects.hpp"

namespace volcomp::sim {
namespace {

std::uint32_t nm_of(double mm) { return static_cast<std::uint32_t>(std::llround(kNmPerMm * mm)); }

double mm_at(const hal::CanFrame& frame, std::size_t at) {
  return static_cast<double>(load_le_signed(&frame.data.at(at), 4)) / kNmPerMm;
}

}  // namespace

void queue_flank(host::SdoChannel& node, const FlankFeature& flank, const FlankFeature& known) {
  namespace object = volcomp::node::object::flank;
  if (flank.gear_id != known.gear_id) node.write(object::gear, flank.gear_id);
  if (flank.gear_id == 0) return;
  const bool all = known.gear_id == 0;
  if (all || flank.side != known.side)
    node.write(object::side, static_cast<std::int8_t>(flank.side));
  if (all || flank.slot != known.slot)
    node.write(object::slot, static_cast<std::uint16_t>(flank.slot));
  if (all || flank.row != known.row) node.write(object::row, static_cast<std::uint8_t>(flank.row));
  if (all || flank.column != known.column)
    node.write(object::column, static_cast<std::uint8_t>(flank.column));
  if (all || nm_of(flank.ball_radius) != nm_of(known.ball_radius))
    node.write(object::radius_nm, nm_of(flank.ball_radius));
  if (all || nm_of(flank.gate) != nm_of(known.gate)) node.write(object::gate_nm, nm_of(flank.gate));
}

void queue_judgement(host::SdoChannel& node, FlankJudgement& judgement) {
  namespace object = volcomp::node::object::probe;
  const auto read = [&node](const auto& value, auto& out) {
    node.read(value, [&out](auto found) { out = static_cast<std::decay_t<decltype(out)>>(found); });
  };
  read(object::distance_nm, judgement.distance_nm);
  read(object::flank_verdict, judgement.verdict);
  read(object::foot, judgement.foot);
  read(object::judged, judgement.sequence);
}

// The mapping of 2401h: node_objects.cpp.
void PointReader::take(std::size_t number, const hal::CanFrame& frame) {
  if (frame.size != 8) return;
  if (number == 0) {
    next_ = {};
    next_.sequence = static_cast<std::uint32_t>(load_le(frame.data.data(), 4));
    next_.verdict = static_cast<TouchVerdict>(frame.data[4]);
    next_.axis = frame.data[5];
    next_.feature = static_cast<std::uint16_t>(load_le(&frame.data[6], 2));
  } else if (number == 1) {
    next_.workpiece.head<2>() << mm_at(frame, 0), mm_at(frame, 4);
  } else {
    next_.workpiece.z() = mm_at(frame, 0);
    next_.uncertainty = static_cast<double>(load_le(&frame.data[4], 4)) / kNmPerMm;
    points_.push_back(next_);
  }
}

}  // namespace volcomp::sim
