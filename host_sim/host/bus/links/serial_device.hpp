#pragma once
// A byte stream to a device: a serial line or pseudo-terminal, raw, or a Unix socket by its path.

#include <cstdint>
#include <string>
#include <string_view>

#include "host_sim/host/bus/links/descriptor.hpp"

namespace volcomp::host {

class SerialDevice {
 public:
  // `name`: PATH, or PATH@BAUD for a serial line that does not run at 115200 baud. Throws UserError
  // naming it.
  explicit SerialDevice(const std::string& name);

  // Bytes taken; fewer than all when there is no room.
  [[nodiscard]] std::size_t write(std::string_view bytes);
  // What has arrived.
  [[nodiscard]] std::string read();
  // Returns when something can be read or the time has passed.
  void wait(std::uint32_t timeout_us) const;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void connect_socket();
  void open_terminal(const std::string& baud);
  void set_raw(const std::string& baud);
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_for(int error) const;

  BrokenPipeIgnored broken_pipe_ignored_;
  std::string path_;
  Descriptor device_;
};

}  // namespace volcomp::host
