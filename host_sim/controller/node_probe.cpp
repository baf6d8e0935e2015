#include "host_sim/controller/node_probe.hpp"

#include <cmath>
#include <cstring>

#include "comp/units.hpp"
#include "firmware/node/probe_objects.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr double kNsPerUs = 1e3;

void write_real(SdoChannel& node, std::uint16_t index, std::size_t sub, double value,
                const char* what) {
  SdoChannel::Bytes bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  node.write({index, static_cast<std::uint8_t>(sub)}, std::move(bytes), what);
}

void write_ns(SdoChannel& node, canopen::ObjectId object, double us, const char* what) {
  node.write_value<std::uint32_t>(object, static_cast<std::uint32_t>(std::llround(us * kNsPerUs)),
                                  what);
}

void write_frame(SdoChannel& node, const Frame& frame) {
  constexpr std::uint16_t kWorkpiece = 0x2303;
  std::size_t sub = 1;
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c)
      write_real(node, kWorkpiece, sub++, frame.R(r, c), "workpiece frame");
  }
  for (Eigen::Index r = 0; r < 3; ++r)
    write_real(node, kWorkpiece, sub++, kNmPerMm * frame.t(r), "workpiece frame");
}

double mm_at(const hal::CanFrame& frame, std::size_t at) {
  return static_cast<double>(canopen::load_le_signed(&frame.data.at(at), 4)) / kNmPerMm;
}

}  // namespace

NodeProbe node_probe(const MachineFile& machine) {
  if (!machine.probe) throw UserError(machine.path + ": the machine has no [probe]");
  NodeProbe probe;
  probe.delay_us = machine.probe->delay_us;
  probe.radius.coefficient[0] = machine.probe->radius_mm;
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    probe.latch_delay_us[a] = machine.axes[a].latch_delay_us;
  return probe;
}

void queue_probe(SdoChannel& node, const NodeProbe& probe) {
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
  node.write_value<std::uint8_t>({0x2300, 1}, static_cast<std::uint8_t>(node::ProbeCommand::on),
                                 "settings of the probe");
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
