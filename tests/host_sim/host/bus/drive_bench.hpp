#pragma once
// A tool on a simulated bus with one drive, and drives that have what a data sheet grants.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host_sim/host/bus/device_files/eds_file.hpp"
#include "host_sim/host/bus/node_client.hpp"
#include "host_sim/sim/controller/simulated_bus.hpp"
#include "host_sim/sim/drives/cia402_drive.hpp"

namespace volcomp::host {

inline constexpr std::uint8_t kDrive = 3;

// A tool on a bus with one device; every frame is kept.
class DriveBench {
 public:
  template <class Device>
  explicit DriveBench(Device& device) : DriveBench() {
    bus.attach(device, "device");
  }
  DriveBench()
      : client(kDrive, [this](NodeClient&) {
          bus.run_until(bus.bus().now_ns() + 1'000'000U);
          return bus.now_us();
        }) {
    bus.bus().set_observer([this](std::uint64_t, const hal::CanFrame& frame,
                                  const hal::LoopbackBus::Port&) { frames.push_back(frame); });
    bus.attach(client, "tool");
  }

  // Requests that would change something: downloads begin with 001 or 110, NMT is 000h.
  [[nodiscard]] std::size_t writing_frames() const {
    std::size_t count = 0;
    for (const hal::CanFrame& frame : frames) {
      const unsigned command = frame.data[0] >> 5U;
      const bool request = frame.id == 0x600 + kDrive;
      if (frame.id == 0 || (request && (command == 1 || command == 6))) ++count;
    }
    return count;
  }

  sim::SimulatedBus bus;
  NodeClient client;
  std::vector<hal::CanFrame> frames;
};

inline std::shared_ptr<const sim::DriveProfile> profile(const std::string& name) {
  return std::make_shared<const sim::DriveProfile>(find_drive_eds(name));
}

}  // namespace volcomp::host
