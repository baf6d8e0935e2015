#include "firmware/node/probe/point_fifo.hpp"

#include "comp/core/bytes.hpp"

namespace volcomp::node {
namespace {

// From the verdict on the flank.
void add_judgement(const JudgedTouch& judged, LittleEndianWriter& writer) {
  const FlankObjects& flank = judged.flank;
  const FaceFoot& foot = judged.touch.foot;
  const bool made = flank.gear != 0;
  writer.u8(made ? static_cast<std::uint8_t>(judged.touch.verdict) : kNotJudged);
  writer.u8(made ? static_cast<std::uint8_t>(foot.reason) : kNotJudged);
  if (!made) return;
  writer.u8(static_cast<std::uint8_t>(flank.side));
  writer.u8(flank.row);
  writer.u8(flank.column);
  writer.go_to(76);
  writer.bits(flank.slot, 2);
  writer.go_to(160);
  writer.f64(judged.touch.distance);
  for (int k = 0; k < 3; ++k)
    writer.f64(foot.point[k]);
}

}  // namespace

PointRecord encode_point(const ProbePoint& point, const Touch& touch, const JudgedTouch& judged) {
  PointRecord record{};
  LittleEndianWriter writer(record);
  writer.u32(point.sequence);
  writer.u32(point.feature);
  writer.u8(static_cast<std::uint8_t>(point.verdict));
  writer.u8(point.axis);
  writer.go_to(16);
  for (const std::int64_t nm : point.machine)
    writer.i64(nm);
  for (const std::int64_t nm : point.workpiece)
    writer.i64(nm);
  for (const float nm : point.uncertainty)
    writer.f32(nm);
  writer.go_to(80);
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    writer.i64(touch.latched[a].position);
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    writer.f64(touch.latched[a].velocity);
  writer.go_to(10);
  add_judgement(judged, writer);
  return record;
}

bool PointFifo::push(const PointRecord& record) {
  if (waiting_ == kCapacity) return false;
  record_[(first_ + waiting_) % kCapacity] = record;
  ++waiting_;
  return true;
}

Span<const std::uint8_t> PointFifo::oldest() const {
  if (waiting_ == 0) return {};
  return {record_[first_].data(), kPointBytes};
}

bool PointFifo::release(std::uint32_t sequence) {
  if (waiting_ == 0 || load_le(record_[first_].data(), 4) != sequence) return false;
  first_ = (first_ + 1) % kCapacity;
  --waiting_;
  return true;
}

}  // namespace volcomp::node
