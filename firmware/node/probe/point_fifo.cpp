#include "firmware/node/probe/point_fifo.hpp"

#include <cstring>

#include "firmware/canopen/bytes.hpp"

namespace volcomp::node {
namespace {

class Writer {
 public:
  explicit Writer(PointRecord& out) : out_(out) {}

  void at(std::size_t place) { at_ = place; }
  void add(std::uint64_t value, std::size_t bytes) {
    canopen::store_le(&out_[at_], bytes, value);
    at_ += bytes;
  }
  void add(std::int64_t value) { add(static_cast<std::uint64_t>(value), 8); }
  void add(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits, sizeof bits);
  }
  void add(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits, sizeof bits);
  }

 private:
  PointRecord& out_;
  std::size_t at_ = 0;
};

// From the verdict on the flank.
void add_judgement(const JudgedTouch& judged, Writer& writer) {
  const FlankObjects& flank = judged.flank;
  const FaceFoot& foot = judged.touch.foot;
  const bool made = flank.gear != 0;
  writer.add(made ? static_cast<std::uint8_t>(judged.touch.verdict) : kNotJudged, 1);
  writer.add(made ? static_cast<std::uint8_t>(foot.reason) : kNotJudged, 1);
  if (!made) return;
  writer.add(static_cast<std::uint8_t>(flank.side), 1);
  writer.add(flank.row, 1);
  writer.add(flank.column, 1);
  writer.at(76);
  writer.add(flank.slot, 2);
  writer.at(160);
  writer.add(judged.touch.distance);
  for (int k = 0; k < 3; ++k)
    writer.add(foot.point[k]);
}

}  // namespace

PointRecord encode_point(const ProbePoint& point, const Touch& touch, const JudgedTouch& judged) {
  PointRecord record{};
  Writer writer(record);
  writer.add(point.sequence, 4);
  writer.add(point.feature, 4);
  writer.add(static_cast<std::uint64_t>(point.verdict), 1);
  writer.add(point.axis, 1);
  writer.at(16);
  for (const std::int64_t nm : point.machine)
    writer.add(nm);
  for (const std::int64_t nm : point.workpiece)
    writer.add(nm);
  for (const float nm : point.uncertainty)
    writer.add(nm);
  writer.at(80);
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    writer.add(touch.latched[a].position);
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    writer.add(touch.latched[a].velocity);
  writer.at(10);
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
  if (waiting_ == 0 || canopen::load_le(record_[first_].data(), 4) != sequence) return false;
  first_ = (first_ + 1) % kCapacity;
  --waiting_;
  return true;
}

}  // namespace volcomp::node
