#include "host_sim/host/bus/bus_cycle.hpp"

#include <algorithm>

#include "hal/loopback/frame_bits.hpp"

namespace volcomp::host {
namespace {

using node::Way;

// Data bytes, as the default mappings of firmware/node/default_pdos.cpp have them.
constexpr std::size_t kSyncBytes = 1;
constexpr std::size_t kTargetBytes = 6;           // 200h + n: 6040h, 607Ah
constexpr std::size_t kActualBytes = 8;           // 180h + n: 6064h, 6041h, 60B9h
constexpr std::size_t kForwardedActualBytes = 7;  // 180h + n: 6064h, 6041h, 6061h
constexpr std::size_t kToDriveBytes = 4;          // 300h + n: 60B0h or 607Ah
constexpr std::size_t kReportBytes = 4;           // 480h + n: 60B0h
constexpr std::size_t kEdgeBytes = 8;             // 280h + n: 60BAh, 60D1h
constexpr std::size_t kToControllerBytes = 8;     // offsets of two axes, way 3
constexpr std::size_t kStatusBytes = 8;

constexpr double kUsableShare = 0.7;
constexpr std::uint32_t kOther_us = hal::worst_case_frame_bits(8);  // at 1 Mbit/s a bit takes 1 µs

std::size_t actual_bytes(const CycleAxis& axis) {
  return axis.way == Way::forwarded_target ? kForwardedActualBytes : kActualBytes;
}

bool is_sent_to(const CycleAxis& axis) {
  return axis.way == Way::offset || axis.way == Way::forwarded_target;
}

// Frames of the node to the controller: the offsets that it adds.
std::size_t frames_to_controller(const CycleAxes& axes) {
  const auto count = std::count_if(axes.begin(), axes.end(), [](const CycleAxis& axis) {
    return axis.way == Way::controller_adds;
  });
  return (static_cast<std::size_t>(count) + 1) / 2;
}

template <class FrameBits>
std::uint32_t sum_of(const CycleAxes& axes, bool with_status, FrameBits bits) {
  std::uint32_t sum = bits(kSyncBytes);
  for (const CycleAxis& axis : axes) {
    sum += bits(kTargetBytes) + bits(actual_bytes(axis));
    if (is_sent_to(axis)) sum += bits(kToDriveBytes);
    if (axis.way == Way::offset && axis.confirmed) sum += bits(kReportBytes);
  }
  sum += static_cast<std::uint32_t>(frames_to_controller(axes)) * bits(kToControllerBytes);
  return with_status ? sum + bits(kStatusBytes) : sum;
}

// SYNC, and of each axis what controller and drive send before the node can know the cycle.
std::int64_t until_last_target(const CycleAxes& axes) {
  std::uint32_t sum = hal::worst_case_frame_bits(kSyncBytes);
  for (const CycleAxis& axis : axes)
    sum +=
        hal::worst_case_frame_bits(kTargetBytes) + hal::worst_case_frame_bits(actual_bytes(axis));
  return sum;
}

std::int64_t frames_of_node(const CycleAxes& axes) {
  const auto to_drives = std::count_if(axes.begin(), axes.end(), is_sent_to);
  return to_drives * std::int64_t{hal::worst_case_frame_bits(kToDriveBytes)} +
         static_cast<std::int64_t>(frames_to_controller(axes)) *
             hal::worst_case_frame_bits(kToControllerBytes);
}

}  // namespace

CycleBits bits_of_cycle(const CycleAxes& axes, bool with_status) {
  return {sum_of(axes, with_status, hal::nominal_frame_bits),
          sum_of(axes, with_status, hal::worst_case_frame_bits)};
}

bool forwards_targets(const CycleAxes& axes) {
  return std::any_of(axes.begin(), axes.end(),
                     [](const CycleAxis& axis) { return axis.way == Way::forwarded_target; });
}

bool needs_status(const CycleAxes& axes) {
  return std::any_of(axes.begin(), axes.end(), [](const CycleAxis& axis) {
    return axis.way == Way::forwarded_target || axis.way == Way::controller_adds;
  });
}

double largest_rate_hz(const CycleAxes& axes, bool with_status) {
  return kUsableShare * kBitRate / bits_of_cycle(axes, with_status).worst;
}

LatencyBudget latency_budget(const CycleAxes& axes, const CycleTimes& times) {
  const std::int64_t own = frames_of_node(axes) + 3 * std::int64_t{kOther_us};
  const auto edges =
      static_cast<std::int64_t>(axes.size()) * hal::worst_case_frame_bits(kEdgeBytes);
  LatencyBudget budget;
  budget.last_target = std::max(until_last_target(axes), std::int64_t{times.last_target});
  budget.deadline =
      times.deadline != 0 ? std::int64_t{times.deadline} : std::int64_t{times.period} * 6 / 10;
  budget.usual = times.period - budget.last_target - own;
  budget.with_edge = budget.usual - edges;
  budget.after_deadline = times.period - budget.deadline - own;
  budget.deadline_from = budget.last_target + 2 * std::int64_t{kOther_us};
  return budget;
}

}  // namespace volcomp::host
