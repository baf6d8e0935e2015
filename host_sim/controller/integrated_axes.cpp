#include "host_sim/controller/integrated_axes.hpp"

#include <algorithm>
#include <cmath>

#include "comp/tables/image.hpp"
#include "comp/tables/machine_tables.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

std::unique_ptr<LoadedCompensator> make_compensator(const CorrectionFile& settings,
                                                    const std::vector<std::uint8_t>& image) {
  if (image.empty()) {
    auto idle = std::make_unique<LoadedCompensator>();
    require(idle->configure(compensator_settings(settings)), "[correction]");
    return idle;
  }
  const auto tables = std::make_unique<MachineTables>();
  require(decode_image(image, kDefaultKnots, *tables), "table image");
  auto compensator =
      std::make_unique<LoadedCompensator>(LoadedMachine<5>{make_runtime_chain(tables->machine)});
  require(compensator->configure(compensator_settings(settings)), "[correction]");
  const Vec3 tool = Eigen::Map<const Vec3>(tables->machine.tool_point.data());
  const std::uint32_t crc = image_crc(image);
  require(compensator->stage(*tables, tool, crc), "table image");
  require(compensator->activate(), "table image");
  return compensator;
}

}  // namespace

LoadedCompensator::Settings compensator_settings(const CorrectionFile& c) {
  LoadedCompensator::Settings s;
  const double period = 1.0 / c.tick_hz;
  for (AxisLimits& l : s.axis) {
    l.limit = static_cast<std::int32_t>(to_nm(c.limit_mm));
    l.rate = static_cast<std::int32_t>(std::max<std::int64_t>(1, to_nm(c.rate_mm_per_s * period)));
    l.soft_rate = std::max(
        1, std::min(l.rate, static_cast<std::int32_t>(to_nm(c.limit_mm * period / c.ramp_s))));
    l.hysteresis = static_cast<std::int32_t>(to_nm(c.hysteresis_mm));
    l.max_step = to_nm(2.0 * c.max_speed_mm_per_s *
                       period);  // seed 001, bad input: a jump beyond v_max·Δt·2
  }
  s.ramp_ticks = static_cast<std::uint32_t>(std::max(1.0, std::round(c.ramp_s * c.tick_hz)));
  return s;
}

IntegratedAxes::IntegratedAxes(const CorrectionFile& settings,
                               const std::vector<std::uint8_t>& image)
    : period_s_(1.0 / settings.tick_hz),
      axes_(period_s_, kDriveTimeConstant_s),
      compensator_(make_compensator(settings, image)),
      loop_(*compensator_, axes_) {}

void IntegratedAxes::cycle(const TargetsNm& target) {
  axes_.set_target(target);
  loop_.on_servo_interrupt();
}

// One ramp moves the offsets of all axes together.
bool IntegratedAxes::ramping() const { return (loop_.last_output().status[0] & kRamping) != 0; }

std::unique_ptr<MotionCell> make_integrated_cell(const TrueMachine& machine,
                                                 const CorrectionFile& correction,
                                                 const std::vector<std::uint8_t>& image) {
  return std::make_unique<MotionCell>(machine, std::make_unique<IntegratedAxes>(correction, image));
}

}  // namespace volcomp::sim
