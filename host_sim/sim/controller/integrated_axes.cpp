#include "host_sim/sim/controller/integrated_axes.hpp"

#include "comp/tables/image.hpp"
#include "comp/tables/machine_tables.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/compensator_settings.hpp"

namespace volcomp::sim {
namespace {

std::unique_ptr<OrientingCompensator> make_compensator(
    const OrientingCompensator::Settings& settings, const std::vector<std::uint8_t>& image) {
  if (image.empty()) {
    auto idle = std::make_unique<OrientingCompensator>();
    host::require(idle->configure(settings), "[correction]");
    return idle;
  }
  const auto tables = std::make_unique<MachineTables>();
  host::require(decode_image(image, kDefaultKnots, *tables), "table image");
  auto compensator =
      std::make_unique<OrientingCompensator>(OrientingMachine{make_runtime_chain(tables->machine)});
  host::require(compensator->configure(settings), "[correction]");
  const Vec3 tool = Eigen::Map<const Vec3>(tables->machine.tool_point.data());
  const std::uint32_t crc = image_crc(image);
  host::require(compensator->stage(*tables, tool, crc), "table image");
  host::require(compensator->activate(), "table image");
  return compensator;
}

}  // namespace

IntegratedAxes::IntegratedAxes(const host::AxisKinds& kinds, const host::CorrectionFile& settings,
                               const std::vector<std::uint8_t>& image)
    : period_s_(1.0 / settings.tick_hz),
      axes_(kinds, period_s_, kDriveTimeConstant_s),
      compensator_(make_compensator(host::compensator_settings(settings, kinds), image)),
      loop_(*compensator_, axes_) {}

void IntegratedAxes::cycle(const host::Targets& target) {
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
                                                 const host::CorrectionFile& correction,
                                                 const std::vector<std::uint8_t>& image) {
  auto axes = std::make_unique<IntegratedAxes>(host::axis_kinds(machine.chain), correction, image);
  return std::make_unique<MotionCell>(machine, std::move(axes));
}

CellFactory watched_integrated_cells(std::string letters, MachineWatch& watch) {
  return [letters = std::move(letters), &watch](const TrueMachine& machine,
                                                const host::CorrectionFile& correction,
                                                const std::vector<std::uint8_t>& image) {
    const host::AxisKinds kinds = host::axis_kinds(machine.chain);
    auto axes = std::make_unique<IntegratedAxes>(kinds, correction, image);
    axes->watch(watch, letters, kinds);
    return std::make_unique<MotionCell>(machine, std::move(axes));
  };
}

}  // namespace volcomp::sim
