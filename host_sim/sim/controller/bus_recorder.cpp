#include "host_sim/sim/controller/bus_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace volcomp::sim {
namespace {

constexpr std::uint64_t kBetweenMachines_us = 1'000'000;

std::uint64_t unix_time_us() {
  using std::chrono::microseconds;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<microseconds>(now).count());
}

}  // namespace

void BusRecorder::record(BusAxes& axes) {
  if (last_us_ != 0) machine_begin_us_ = last_us_ + kBetweenMachines_us;
  axes.bus().bus().set_observer([this](std::uint64_t time_ns, const hal::CanFrame& frame,
                                       const hal::LoopbackBus::Port&) { write(time_ns, frame); });
}

// A wall clock may be set back; a log's time never runs backwards.
void BusRecorder::write(std::uint64_t bus_ns, const hal::CanFrame& frame) {
  const std::uint64_t time_us =
      clock_ == Clock::wall ? unix_time_us() : machine_begin_us_ + bus_ns / 1000U;
  last_us_ = std::max(last_us_, time_us);
  log_.write(last_us_, frame);
}

BusAxesFactory recorded(BusAxesFactory make_axes, BusRecorder& recorder) {
  return [make_axes = std::move(make_axes), &recorder](const host::BusSettings& settings,
                                                       const std::vector<std::uint8_t>& image) {
    auto axes = make_axes(settings, image);
    recorder.record(*axes);
    return axes;
  };
}

}  // namespace volcomp::sim
