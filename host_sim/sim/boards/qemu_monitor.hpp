#pragma once
// Reads the progress of the processor of a running QEMU over its machine protocol (QMP).

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/host/bus/links/serial_device.hpp"

namespace volcomp::sim {

class QemuMonitor {
 public:
  // `socket`: the Unix socket on which QEMU listens (-qmp). Throws UserError naming it, here and
  // later, when there is no answer or none of QEMU.
  explicit QemuMonitor(const std::string& socket);

  // Executed since the start. QEMU counts with -icount only. It answers in its main loop, each turn
  // of which also takes one frame out of a CAN interface: a call takes in one that waits there.
  [[nodiscard]] std::uint64_t instructions();

 private:
  [[nodiscard]] nlohmann::json ask(const char* command);
  [[nodiscard]] nlohmann::json next_message();
  [[noreturn]] void fail(const char* what) const;

  host::SerialDevice socket_;
  std::string incoming_;
};

}  // namespace volcomp::sim
