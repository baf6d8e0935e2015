// Any bytes as recorded CAN traffic or as a table of strokes: accepted or refused with a UserError.
// What is accepted runs forwards in time; a frame survives writing and reading.

#include <cmath>
#include <cstring>
#include <sstream>
#include <string_view>

#include "host_sim/host/bus/can_log.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/strokes/stroke_log.hpp"

namespace {

using namespace volcomp;

void check(bool good) {
  if (!good) __builtin_trap();
}

void read_traffic(const std::string& text) {
  std::uint64_t last_us = 0;
  for (const host::LoggedFrame& logged : host::parse_can_log(text, "can.log")) {
    check(logged.time_us >= last_us && logged.line > 0 && logged.frame.size <= 8);
    last_us = logged.time_us;
    const std::string line = host::log_line(logged.time_us, "can0", logged.frame);
    const auto again = host::parse_log_line(line, "written.log", 1);
    check(again && again->time_us == logged.time_us && again->frame.id == logged.frame.id &&
          again->frame.size == logged.frame.size &&
          std::memcmp(again->frame.data.data(), logged.frame.data.data(), logged.frame.size) == 0);
  }
}

void read_strokes(const std::string& text) {
  std::istringstream stream(text);
  const host::StrokeLog log = host::read_stroke_table(stream, "strokes.csv");
  check(log.samples.size() >= 2 && log.period_s > 0.0);
  double last_s = -INFINITY;
  for (const host::StrokeSample& sample : log.samples) {
    check(sample.time_s >= last_s && std::isfinite(sample.z.actual) &&
          std::isfinite(sample.c.command));
    last_s = sample.time_s;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (void (*const read)(const std::string&) : {read_traffic, read_strokes}) {
    try {
      read(text);
    } catch (const host::UserError&) {
    }
  }
  return 0;
}
