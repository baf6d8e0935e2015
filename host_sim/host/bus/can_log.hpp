#pragma once
// Recorded CAN traffic in the format of `candump -L` (can-utils): one frame per line,
//
//   (1700000000.123456) can0 1A0#1CDF442102000000

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/can_port.hpp"
#include "host_sim/host/io/file_draft.hpp"
#include "host_sim/host/io/interruption.hpp"

namespace volcomp::host {

struct LoggedFrame {
  std::uint64_t time_us = 0;      // the log's own clock, without its settings
  std::size_t line = 0;           // in the file, from 1
  std::int64_t clock_set_us = 0;  // before this frame, by so much
  hal::CanFrame frame{};
};

// The frames of a log. The kernel takes the time stamp when a frame is sent, but may hand two
// frames to a listener the other way round: a frame up to 0.1 s older than the line before it goes
// to its place when one of the next three lines is as new again and it overtakes none of its
// identifier. Otherwise the clock was set back there (NTP does): the lines keep their order, and
// time goes on with the spacing of the two frames before. Frames a CANopen network does not use are
// left out: 29-bit identifiers, remote requests, error reports. Throws UserError naming `name` and
// line for what is no log line.
[[nodiscard]] std::vector<LoggedFrame> parse_can_log(std::string_view text,
                                                     const std::string& name);
[[nodiscard]] std::vector<LoggedFrame> read_can_log(const std::filesystem::path& path);

// One line of a log, the frame it holds: nothing for an empty line and for frames of no use.
// Throws UserError naming `name` and the line, as parse_can_log.
[[nodiscard]] std::optional<LoggedFrame> parse_log_line(std::string_view line,
                                                        const std::string& name,
                                                        std::size_t number);

// Time that never runs backwards, for readers that do not wait for the next lines: after a clock
// was set back by more than 0.1 s it continues from there.
class SteadyTime {
 public:
  [[nodiscard]] std::uint64_t of(const LoggedFrame& logged);

 private:
  std::uint64_t last_us_ = 0;
  std::uint64_t set_back_us_ = 0;  // so far
};

// One line, without its end.
[[nodiscard]] std::string log_line(std::uint64_t time_us, std::string_view interface,
                                   const hal::CanFrame& frame);

// Appears whole, as every result: a run that is interrupted or fails leaves the earlier log. What
// is no file, a pipe for instance, and standard output ("-") get it while it grows.
class CanLogWriter {
 public:
  // All throw UserError when it cannot be written, and Interrupted where there is a file to remove.
  CanLogWriter(const std::filesystem::path& path, std::string interface);

  void write(std::uint64_t time_us, const hal::CanFrame& frame);
  void finish();

 private:
  void check() const;

  FileDraft draft_;
  std::optional<Interruption> interruption_;  // while there is a file to remove
  std::string interface_;
};

}  // namespace volcomp::host
