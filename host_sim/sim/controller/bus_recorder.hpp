#pragma once
// Records every frame of simulated machines on a bus.

#include "host_sim/host/bus/can_log.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"

namespace volcomp::sim {

// One log for the machines of a scenario, which exist one after the other. All frames of the
// simulated bus in its order.
class BusRecorder {
 public:
  enum class Clock : std::uint8_t {
    machine,  // time of the simulated bus, one machine following the other
    wall,     // Unix time: the machine is on a real bus too
  };
  // `log` must outlive the recorder.
  BusRecorder(host::CanLogWriter& log, Clock clock) : log_(log), clock_(clock) {}

  // Records from now on until these axes end; the recorder must outlive them.
  void record(BusAxes& axes);

 private:
  void write(std::uint64_t bus_ns, const hal::CanFrame& frame);

  host::CanLogWriter& log_;
  Clock clock_;
  std::uint64_t machine_begin_us_ = 0;
  std::uint64_t last_us_ = 0;
};

// Axes that are recorded from their first frame. The recorder must outlive them.
[[nodiscard]] BusAxesFactory recorded(BusAxesFactory make_axes, BusRecorder& recorder);

}  // namespace volcomp::sim
