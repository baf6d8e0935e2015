// Strokes as recorded CAN traffic: what was commanded for a SYNC, and what the drives read at it.

#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/host/bus/bus_settings.hpp"
#include "host_sim/host/bus/can_log.hpp"
#include "host_sim/host/bus/device_files/bus_messages.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/strokes/stroke_log.hpp"

namespace volcomp::host {
namespace {

constexpr double kNominalCycle_hz = 500.0;  // no message depends on it
constexpr double kUsPerS = 1e6;

// A rotary drive counts through and wraps after two turns (device_files/dbc.cpp): the same angle,
// as near to another one as may be.
double beside(double near, double rad) {
  constexpr double kWrap = 4.0 * kPi;
  return rad + kWrap * std::round((near - rad) / kWrap);
}

class FrameReader {
 public:
  explicit FrameReader(const MachineFile& machine) {
    BusSettings bus = bus_settings(machine, kNominalCycle_hz);
    bus.strokes = watched_strokes(grinding_of(machine), kNodeSpacing_mm, 1.0 / kNominalCycle_hz);
    for (BusMessage& m : bus_messages(bus))
      message_.emplace(m.id, std::move(m));
  }

  void take(const LoggedFrame& logged, std::vector<StrokeSample>& samples) {
    if (logged.frame.id == canopen::kSync) {
      finish(samples);
      begin(logged);
      return;
    }
    const auto found = message_.find(logged.frame.id);
    if (found == message_.end()) return;
    const BusMessage& m = found->second;
    for (Axis& axis : axis_) {
      if (m.name[0] != axis.letter) continue;
      if (const auto target = position(m, "TargetPosition", logged, axis))
        axis.target = axis.letter == 'C' ? beside(axis.target.value_or(*target), *target) : *target;
      if (const auto actual = position(m, "ActualPosition", logged, axis)) axis.actual = actual;
    }
    if (const auto slot = signal_value(m, "Slot", logged.frame))
      slot_ = static_cast<std::uint16_t>(*slot);
  }

  // The sample of the last SYNC, where everything of it has come.
  void finish(std::vector<StrokeSample>& samples) {
    if (!open_ || !axis_[1].complete() || !axis_[2].complete()) return;
    sample_.x = axis_[0].complete() ? axis_[0].logged() : LoggedAxis{};
    sample_.z = axis_[1].logged();
    sample_.c = axis_[2].logged();
    has_x_ = has_x_ && axis_[0].complete();
    samples.push_back(sample_);
  }

  [[nodiscard]] bool has_x() const { return has_x_; }

 private:
  struct Axis {
    char letter;
    std::optional<double> target{};   // newest
    std::optional<double> command{};  // as it was at the SYNC
    std::optional<double> actual{};   // since the SYNC

    [[nodiscard]] bool complete() const { return command && actual; }
    [[nodiscard]] LoggedAxis logged() const {
      return {*command, letter == 'C' ? beside(*command, *actual) : *actual};
    }
  };

  void begin(const LoggedFrame& logged) {
    open_ = true;
    sample_ = {};
    sample_.time_s = static_cast<double>(logged.time_us) / kUsPerS;
    sample_.line = logged.line;
    sample_.slot = slot_;
    for (Axis& axis : axis_) {
      axis.command = axis.target;
      axis.actual.reset();
    }
  }

  static std::optional<double> position(const BusMessage& m, const char* signal,
                                        const LoggedFrame& logged, const Axis& axis) {
    const std::optional<double> value = signal_value(m, signal, logged.frame);
    if (!value) return value;
    return axis.letter == 'C' ? *value * kPi / 180.0 : *value / kNmPerMm;
  }

  std::map<std::uint16_t, BusMessage> message_;
  std::array<Axis, 3> axis_{Axis{'X'}, Axis{'Z'}, Axis{'C'}};
  std::optional<std::uint16_t> slot_;
  StrokeSample sample_;
  bool open_ = false;
  bool has_x_ = true;
};

}  // namespace

StrokeLog read_stroke_frames(std::istream& stream, const std::string& name,
                             const MachineFile& machine) {
  const std::string text((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  FrameReader reader(machine);
  StrokeLog log{name, 0.0, false, {}};
  for (const LoggedFrame& logged : parse_can_log(text, name))
    reader.take(logged, log.samples);
  reader.finish(log.samples);
  if (log.samples.size() < 2)
    throw UserError(
        fmt::format("{}: there are not two cycles with SYNC, targets and positions of "
                    "Z and C on the bus of {}",
                    name, machine.name));
  log.has_x = reader.has_x();
  set_period(log);
  return log;
}

}  // namespace volcomp::host
