#include "host_sim/sim/controller/node_probe.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "comp/core/units.hpp"
#include "firmware/node/probe/probe_objects.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr double kNsPerUs = 1e3;

void write_real(host::SdoChannel& node, std::uint16_t index, std::size_t sub, double value,
                const char* what) {
  host::SdoChannel::Bytes bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  node.write({index, static_cast<std::uint8_t>(sub)}, std::move(bytes), what);
}

void write_ns(host::SdoChannel& node, canopen::ObjectId object, double us, const char* what) {
  node.write_value<std::uint32_t>(object, static_cast<std::uint32_t>(std::llround(us * kNsPerUs)),
                                  what);
}

void write_frame(host::SdoChannel& node, const Frame& frame) {
  constexpr std::uint16_t kWorkpiece = 0x2303;
  std::size_t sub = 1;
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c)
      write_real(node, kWorkpiece, sub++, frame.R(r, c), "workpiece frame");
  }
  for (Eigen::Index r = 0; r < 3; ++r)
    write_real(node, kWorkpiece, sub++, kNmPerMm * frame.t(r), "workpiece frame");
}

void write_gear(host::SdoChannel& node, const NodeProbe& probe) {
  const FaceGear& g = probe.gear;
  const std::array<double, 11> numbers{static_cast<double>(g.shaper_teeth),
                                       static_cast<double>(g.teeth),
                                       g.module,
                                       g.pressure_angle,
                                       g.addendum,
                                       g.shaper_addendum,
                                       g.r_in,
                                       g.r_out,
                                       g.relief.amount,
                                       g.relief.begin,
                                       g.relief.length};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    write_real(node, 0x2312, i + 1, numbers[i], "face gear");
  node.write_value<std::uint32_t>({0x2311, 1}, probe.gear_id, "face gear");
}

std::uint32_t nm_of(double mm) { return static_cast<std::uint32_t>(std::llround(kNmPerMm * mm)); }

double mm_at(const hal::CanFrame& frame, std::size_t at) {
  return static_cast<double>(canopen::load_le_signed(&frame.data.at(at), 4)) / kNmPerMm;
}

}  // namespace

NodeProbe node_probe(const host::MachineFile& machine) {
  if (!machine.probe) throw host::UserError(machine.path + ": the machine has no [probe]");
  NodeProbe probe;
  probe.delay_us = machine.probe->delay_us;
  probe.radius.coefficient[0] = machine.probe->radius_mm;
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    probe.latch_delay_us[a] = machine.axes[a].latch_delay_us;
  return probe;
}

void queue_probe(host::SdoChannel& node, const NodeProbe& probe) {
  write_ns(node, {0x2300, 2}, probe.delay_us, "probe delay");
  for (std::size_t a = 0; a < node::kNodeAxes; ++a)
    write_ns(node, {0x2301, static_cast<std::uint8_t>(a + 1)}, probe.latch_delay_us[a],
             "latch delay");
  for (std::size_t k = 0; k < kLobingTerms; ++k)
    write_real(node, 0x2302, k + 1, kNmPerMm * probe.radius.coefficient[k], "effective radius");
  write_frame(node, probe.workpiece);
  write_real(node, 0x2304, 1, kNmPerMm * probe.radius_uncertainty, "uncertainty of the radius");
  write_real(node, 0x2304, 2, kNmPerMm * probe.tool_length_uncertainty,
             "uncertainty of the tool length");
  write_real(node, 0x2304, 4, kNmPerMm * probe.repeatability, "repeatability of the probe");
  if (probe.gear_id != 0) write_gear(node, probe);
  node.write_value<std::uint8_t>({0x2300, 1}, static_cast<std::uint8_t>(node::ProbeCommand::on),
                                 "settings of the probe");
}

void queue_flank(host::SdoChannel& node, const FlankFeature& flank, const FlankFeature& known) {
  constexpr const char* kWhat = "flank";
  constexpr std::uint16_t kFlank = 0x2313;
  if (flank.gear_id != known.gear_id)
    node.write_value<std::uint32_t>({kFlank, 1}, flank.gear_id, kWhat);
  if (flank.gear_id == 0) return;
  const bool all = known.gear_id == 0;
  if (all || flank.side != known.side)
    node.write_value<std::int8_t>({kFlank, 2}, static_cast<std::int8_t>(flank.side), kWhat);
  if (all || flank.slot != known.slot)
    node.write_value<std::uint16_t>({kFlank, 3}, static_cast<std::uint16_t>(flank.slot), kWhat);
  if (all || flank.row != known.row)
    node.write_value<std::uint8_t>({kFlank, 4}, static_cast<std::uint8_t>(flank.row), kWhat);
  if (all || flank.column != known.column)
    node.write_value<std::uint8_t>({kFlank, 5}, static_cast<std::uint8_t>(flank.column), kWhat);
  if (all || nm_of(flank.ball_radius) != nm_of(known.ball_radius))
    node.write_value<std::uint32_t>({kFlank, 6}, nm_of(flank.ball_radius), kWhat);
  if (all || nm_of(flank.gate) != nm_of(known.gate))
    node.write_value<std::uint32_t>({kFlank, 7}, nm_of(flank.gate), kWhat);
}

void queue_judgement(host::SdoChannel& node, FlankJudgement& judgement) {
  constexpr const char* kWhat = "judgement of a touch";
  const auto read = [&](std::uint8_t sub, auto take) {
    node.read({0x2401, sub}, 4, kWhat,
              [take](const host::SdoChannel::Bytes& b) { take(host::number(b)); });
  };
  read(12, [&judgement](std::uint64_t n) {
    judgement.distance_nm = static_cast<std::int32_t>(static_cast<std::uint32_t>(n));
  });
  read(13, [&judgement](std::uint64_t n) { judgement.verdict = static_cast<Reason>(n); });
  read(14, [&judgement](std::uint64_t n) { judgement.foot = static_cast<Reason>(n); });
  read(15, [&judgement](std::uint64_t n) { judgement.sequence = static_cast<std::uint32_t>(n); });
}

// The mapping of 2401h: node_objects.cpp.
void PointReader::take(std::size_t number, const hal::CanFrame& frame) {
  if (frame.size != 8) return;
  if (number == 0) {
    next_ = {};
    next_.sequence = static_cast<std::uint32_t>(canopen::load_le(frame.data.data(), 4));
    next_.verdict = static_cast<TouchVerdict>(frame.data[4]);
    next_.axis = frame.data[5];
    next_.feature = static_cast<std::uint16_t>(canopen::load_le(&frame.data[6], 2));
  } else if (number == 1) {
    next_.workpiece.head<2>() << mm_at(frame, 0), mm_at(frame, 4);
  } else {
    next_.workpiece.z() = mm_at(frame, 0);
    next_.uncertainty = static_cast<double>(canopen::load_le(&frame.data[4], 4)) / kNmPerMm;
    points_.push_back(next_);
  }
}

}  // namespace volcomp::sim
