#include "host_sim/sim/controller/integrated_axes.hpp"

#include <algorithm>
#include <cmath>

#include "comp/tables/image.hpp"
#include "comp/tables/machine_tables.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::sim {
namespace {

std::unique_ptr<OrientingCompensator> make_compensator(
    const OrientingCompensator::Settings& settings, const std::vector<std::uint8_t>& image) {
  if (image.empty()) {
    auto idle = std::make_unique<OrientingCompensator>();
    require(idle->configure(settings), "[correction]");
    return idle;
  }
  const auto tables = std::make_unique<MachineTables>();
  require(decode_image(image, kDefaultKnots, *tables), "table image");
  auto compensator =
      std::make_unique<OrientingCompensator>(OrientingMachine{make_runtime_chain(tables->machine)});
  require(compensator->configure(settings), "[correction]");
  const Vec3 tool = Eigen::Map<const Vec3>(tables->machine.tool_point.data());
  const std::uint32_t crc = image_crc(image);
  require(compensator->stage(*tables, tool, crc), "table image");
  require(compensator->activate(), "table image");
  return compensator;
}

// What a machine file says about the correction of one axis: mm or rad.
struct AxisCorrection {
  double limit;
  double rate_per_s;
  double hysteresis;
  double max_speed_per_s;
};

// Offsets of a rotary axis count in 2^-32 turn, its positions in 2^-40 turn.
AxisLimits in_units(const AxisCorrection& c, bool rotary, double period_s, double ramp_s) {
  const double position_units = rotary ? kUnitsPerRad : kNmPerMm;
  const double offset_units = rotary ? kUnitsPerRad / 256.0 : kNmPerMm;
  const auto offset = [offset_units](double value) {
    return static_cast<std::int32_t>(
        std::min<std::int64_t>(to_units(value, offset_units), INT32_MAX));
  };
  AxisLimits l;
  l.limit = offset(c.limit);
  l.rate = std::max(1, offset(c.rate_per_s * period_s));
  l.soft_rate = std::max(1, std::min(l.rate, offset(c.limit * period_s / ramp_s)));
  l.hysteresis = offset(c.hysteresis);
  // seed 001, bad input: a jump beyond v_max·Δt·2
  l.max_step = to_units(2.0 * c.max_speed_per_s * period_s, position_units);
  return l;
}

}  // namespace

OrientingCompensator::Settings compensator_settings(const CorrectionFile& c,
                                                    const AxisKinds& kinds) {
  OrientingCompensator::Settings s;
  const double period = 1.0 / c.tick_hz;
  for (std::size_t a = 0; a < s.axis.size(); ++a) {
    const AxisCorrection values =
        kinds.rotary[a]
            ? AxisCorrection{c.limit_rad, c.rate_rad_per_s, c.hysteresis_rad, c.max_speed_rad_per_s}
            : AxisCorrection{c.limit_mm, c.rate_mm_per_s, c.hysteresis_mm, c.max_speed_mm_per_s};
    s.axis[a] = in_units(values, kinds.rotary[a], period, c.ramp_s);
  }
  s.ramp_ticks = static_cast<std::uint32_t>(std::max(1.0, std::round(c.ramp_s * c.tick_hz)));
  return s;
}

IntegratedAxes::IntegratedAxes(const AxisKinds& kinds, const CorrectionFile& settings,
                               const std::vector<std::uint8_t>& image)
    : period_s_(1.0 / settings.tick_hz),
      axes_(kinds, period_s_, kDriveTimeConstant_s),
      compensator_(make_compensator(compensator_settings(settings, kinds), image)),
      loop_(*compensator_, axes_) {}

void IntegratedAxes::cycle(const Targets& target) {
  axes_.set_target(target);
  loop_.on_servo_interrupt();
  show();
}

void IntegratedAxes::add_states(MachineSnapshot& snapshot) const {
  for (std::size_t a = 0; a < snapshot.axes; ++a)
    snapshot.axis[a].correction_status = loop_.last_output().status[a];
}

// One ramp moves the offsets of all axes together.
bool IntegratedAxes::ramping() const { return (loop_.last_output().status[0] & kRamping) != 0; }

std::unique_ptr<MotionCell> make_integrated_cell(const TrueMachine& machine,
                                                 const CorrectionFile& correction,
                                                 const std::vector<std::uint8_t>& image) {
  auto axes = std::make_unique<IntegratedAxes>(axis_kinds(machine.chain), correction, image);
  return std::make_unique<MotionCell>(machine, std::move(axes));
}

CellFactory watched_integrated_cells(std::string letters, MachineWatch& watch) {
  return [letters = std::move(letters), &watch](const TrueMachine& machine,
                                                const CorrectionFile& correction,
                                                const std::vector<std::uint8_t>& image) {
    const AxisKinds kinds = axis_kinds(machine.chain);
    auto axes = std::make_unique<IntegratedAxes>(kinds, correction, image);
    axes->watch(watch, letters, kinds);
    return std::make_unique<MotionCell>(machine, std::move(axes));
  };
}

}  // namespace volcomp::sim
