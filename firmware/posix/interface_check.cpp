#include "firmware/posix/interface_check.hpp"

namespace volcomp::posix {
namespace {

constexpr std::uint32_t kPlannedBitRate = 1'000'000;  // of all times in docs/drives.md
constexpr std::uint32_t kLongestQueue = 16;           // a cycle has at most twelve frames

}  // namespace

std::vector<std::string> remarks(const hal::CanInterface& found, bool forwards) {
  std::vector<std::string> said;
  if (!found.known) return {"how it is set up cannot be read"};
  if (!found.controller) return said;
  if (found.bit_rate == 0) {
    said.emplace_back("its bit rate is not known; the node is made for 1 Mbit/s");
  } else if (found.bit_rate != kPlannedBitRate) {
    said.push_back("its bit rate is " + std::to_string(found.bit_rate) +
                   " bit/s; the node is made for 1 Mbit/s");
  }
  if (found.queue > kLongestQueue) {
    said.push_back("its queue has room for " + std::to_string(found.queue) +
                   " frames and so for old offsets (txqueuelen 16)");
  }
  if (forwards && found.restart_ms != 0) {
    said.emplace_back(
        "it comes back from bus-off by itself, while targets of drives are gone (restart-ms 0)");
  }
  if (!forwards && found.restart_ms == 0)
    said.emplace_back("it does not come back from bus-off by itself (restart-ms 100)");
  if (found.reports_bus_errors)
    said.emplace_back("every error on the bus interrupts the computer (berr-reporting off)");
  if (forwards && !found.echoes) {
    said.emplace_back(
        "its driver does not tell when a frame has been on the bus: a late target is not noticed");
  }
  return said;
}

}  // namespace volcomp::posix
