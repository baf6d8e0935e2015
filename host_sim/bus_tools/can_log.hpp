#pragma once
// Recorded CAN traffic in the format of `candump -L` (can-utils): one frame per line,
//
//   (1700000000.123456) can0 1A0#1CDF442102000000

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/can_port.hpp"

namespace volcomp::sim {

struct LoggedFrame {
  std::uint64_t time_us = 0;  // the log's own clock
  std::size_t line = 0;       // in the file, from 1
  hal::CanFrame frame{};
};

// The frames of a log in the order of their time stamps: the kernel takes those when a frame is
// sent, but may hand two frames to a listener the other way round. Frames a CANopen network does
// not use are left out: 29-bit identifiers, remote requests, error reports. Throws UserError naming
// `name` and line for what is no log line, and where time runs backwards by more than 0.1 s.
[[nodiscard]] std::vector<LoggedFrame> parse_can_log(std::string_view text,
                                                     const std::string& name);
[[nodiscard]] std::vector<LoggedFrame> read_can_log(const std::filesystem::path& path);

// One line, without its end.
[[nodiscard]] std::string log_line(std::uint64_t time_us, std::string_view interface,
                                   const hal::CanFrame& frame);

class CanLogWriter {
 public:
  // All throw UserError when the file cannot be written.
  CanLogWriter(const std::filesystem::path& path, std::string interface);

  void write(std::uint64_t time_us, const hal::CanFrame& frame);
  void finish();

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
  std::string interface_;
};

}  // namespace volcomp::sim
