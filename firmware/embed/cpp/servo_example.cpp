#include "firmware/embed/cpp/servo_example.hpp"

#include <algorithm>

#include "comp/tables/image.hpp"

namespace volcomp::example {
namespace {

struct Travel {
  std::int32_t lower;  // counts
  std::int32_t upper;
  std::int32_t step;  // counts per servo period
};

// 110, 65 and 35 mm/s, a little beyond the tables at the lower end of X.
constexpr std::array<Travel, kAxes> kTravel = {{
    {-50'200'000, -100'000, 2200},
    {-29'900'000, -100'000, 1300},
    {-39'900'000, -100'000, 700},
}};

constexpr std::uint32_t kSignalFails = 12'000;  // servo periods since the start
constexpr std::uint32_t kSignalReturns = 12'050;
constexpr std::uint32_t kFailingAxis = 1;

// 5 mm/s and 0.2 m/s² of offset, 0.4 s for a change, plausible up to 0.5 m/s.
XyfzCompensator::Settings settings() {
  XyfzCompensator::Settings s;
  for (AxisLimits& axis : s.axis) {
    axis.limit = 200'000;
    axis.rate = 1'000;
    axis.soft_rate = 100;
    axis.acceleration = 8;
    axis.hysteresis = 2'000;
    axis.max_step = 100'000;
  }
  s.ramp_ticks = 2'000;
  s.stale_drop_ticks = 20;
  return s;
}

}  // namespace

void EncoderPort::sample(XyfzCompensator::Input& in) noexcept {
  const std::uint32_t no_signal = registers_.no_signal;
  for (std::size_t a = 0; a < kAxes; ++a) {
    in.axis[a].position = kNmPerCount * registers_.count[a];
    in.axis[a].valid = (no_signal >> a & 1U) == 0;
    in.axis[a].homed = true;
  }
}

void EncoderPort::apply(const XyfzCompensator::Output& out) noexcept {
  for (std::size_t a = 0; a < kAxes; ++a)
    registers_.offset_nm[a] = out.offset[a];
}

void SimulatedMachine::advance() {
  for (std::size_t a = 0; a < kAxes; ++a) {
    const Travel& travel = kTravel[a];
    const std::int32_t here = periods_ == 0 ? travel.upper : registers_.count[a];
    if (here <= travel.lower) upwards_[a] = true;
    if (here >= travel.upper) upwards_[a] = false;
    registers_.count[a] = here + (upwards_[a] ? travel.step : -travel.step);
  }
  const bool failed = periods_ >= kSignalFails && periods_ < kSignalReturns;
  registers_.no_signal = failed ? 1U << kFailingAxis : 0U;
  ++periods_;
}

void OffsetSummary::add(const XyfzCompensator::Output& out) {
  constexpr std::uint32_t kPrime = 16777619U;
  for (std::size_t a = 0; a < kAxes; ++a) {
    least_nm[a] = std::min(least_nm[a], out.offset[a]);
    largest_nm[a] = std::max(largest_nm[a], out.offset[a]);
    last_nm[a] = out.offset[a];
    fingerprint = (fingerprint ^ static_cast<std::uint32_t>(out.offset[a])) * kPrime;
    fingerprint = (fingerprint ^ out.status[a]) * kPrime;
  }
  ++periods;
}

Status ServoExample::commission(Span<const std::uint8_t> image) {
  TablesView tables;
  if (const Status s = check_image(image, kDefaultKnots, tables); !s.ok()) return s;
  if (const Status s = compensator_.configure(settings()); !s.ok()) return s;
  const std::array<double, 3>& tool = kXyfzMachine.tool_point;
  if (const Status s = compensator_.stage(tables, {tool[0], tool[1], tool[2]}, image_crc(image));
      !s.ok())
    return s;
  return compensator_.activate();
}

}  // namespace volcomp::example
