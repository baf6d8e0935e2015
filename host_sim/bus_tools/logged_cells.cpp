#include "host_sim/bus_tools/logged_cells.hpp"

#include <algorithm>
#include <chrono>

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

CellFactory logged_cells(const MachineFile& machine, double cycle_hz, CanGateway* gateway,
                         BusRecorder& recorder) {
  return [machine, cycle_hz, gateway, &recorder](const TrueMachine& truth,
                                                 const CorrectionFile& correction,
                                                 const std::vector<std::uint8_t>& image) {
    MachineFile corrected = machine;
    corrected.correction = correction;
    const BusSettings settings = bus_settings(corrected, cycle_hz);
    auto axes = gateway == nullptr ? std::make_unique<BusAxes>(settings, image)
                                   : std::make_unique<BusAxes>(settings, image, *gateway);
    recorder.record(*axes);
    return std::make_unique<MotionCell>(truth, std::move(axes));
  };
}

}  // namespace volcomp::sim
