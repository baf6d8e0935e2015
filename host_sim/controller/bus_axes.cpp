#include "host_sim/controller/bus_axes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/controller/integrated_axes.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint64_t kSyncPhase_ns = 300'000;  // after SYNC, before the targets are sent
constexpr std::size_t kGatewayMailboxes = 4096;
constexpr std::uint64_t kAnswerTimeout_us = 5'000'000;
constexpr std::uint32_t kWait_us = 200;

std::vector<std::int32_t> on_wire(const TargetsNm& target) {
  std::vector<std::int32_t> wire;
  for (const std::int64_t nm : target) {
    if (nm > INT32_MAX || nm < INT32_MIN)
      throw UserError(fmt::format("{} nm is beyond the 32 bits of 607Ah", nm));
    wire.push_back(static_cast<std::int32_t>(nm));
  }
  return wire;
}

BusSettings lock_step(BusSettings settings) {
  constexpr std::uint32_t kDeadline_us = 60'000'000;
  settings.deadline_us = kDeadline_us;
  settings.status_every_cycle = true;
  settings.heartbeat_timeout_ms = 30'000;
  return settings;
}

}  // namespace

BusAxes::BusAxes(const BusSettings& settings, const std::vector<std::uint8_t>& image,
                 hal::FrameLength length)
    : period_us_(settings.period_us),
      bus_(length),
      controller_(settings, image),
      node_(std::make_unique<node::Node>(settings.node, nullptr)) {
  build(settings);
  node_port_ = &bus_.attach(*node_, "node");
  node_->power_on(0);
}

BusAxes::BusAxes(const BusSettings& settings, const std::vector<std::uint8_t>& image,
                 CanGateway& gateway)
    : period_us_(settings.period_us), controller_(lock_step(settings), image), gateway_(&gateway) {
  build(settings);
  gateway_port_ = &bus_.attach_served("gateway", {}, kGatewayMailboxes);
}

void BusAxes::build(const BusSettings& settings) {
  if (settings.axes.size() != kGroupAxes)
    throw UserError(fmt::format("the simulated bus has {} axes, the machine has {}", kGroupAxes,
                                settings.axes.size()));
  bus_.attach(controller_, "controller");
  for (const BusAxis& axis : settings.axes) {
    Cia402Drive::Settings s;
    s.node_id = axis.drive;
    s.rotary = axis.rotary;
    s.period_s = period_s();
    s.time_constant_s = kDriveTimeConstant_s;
    drive_.push_back(std::make_unique<Cia402Drive>(s));
    drive_port_.push_back(&bus_.attach(*drive_.back(), fmt::format("drive {}", axis.letter)));
    drive_.back()->power_on(0);
  }
}

void BusAxes::stand_at(const Vec3& mm) {
  if (up_) throw std::logic_error("axes on a bus cannot be put elsewhere while they run");
  target_ = to_targets(mm);
  for (std::size_t a = 0; a < kGroupAxes; ++a)
    drive_[a]->stand_at(target_[a]);
}

void BusAxes::power_drive(std::size_t a, bool on) {
  drive_port_.at(a)->connect(on);
  if (on) {
    drive_[a]->power_on(bus_.now_us());
  } else {
    drive_[a]->power_off();
  }
}

void BusAxes::power_node(bool on) {
  node_port_->connect(on);
  if (on) node_->power_on(bus_.now_us());
}

// SYNC, the answers of the drives; then the targets, and what the node makes of them.
void BusAxes::run_cycle(const std::vector<std::int32_t>& path) {
  controller_.send_targets(path);
  const auto period_ns = static_cast<std::uint64_t>(std::llround(period_us_ * 1000.0));
  next_sync_ns_ += period_ns;
  bus_.run_until(next_sync_ns_);
  if (gateway_ != nullptr) await_node();
  next_sync_ns_ = std::max(next_sync_ns_, bus_.bus().now_ns());
  controller_.send_sync();
  bus_.run_until(next_sync_ns_ + kSyncPhase_ns);
  ++cycles_;
}

// Lock step while the node answers every cycle; before that, its own time.
void BusAxes::await_node() {
  const std::uint64_t begin_us = gateway_->now_us();
  const auto period_us = static_cast<std::uint64_t>(std::llround(period_us_));
  const bool answers = controller_.node().state == canopen::NmtState::operational &&
                       controller_.node().phase == Station::Phase::running &&
                       controller_.report().count > 0;
  while (true) {
    bus_.run_until_quiet();
    gateway_->exchange(*gateway_port_);
    bus_.run_until_quiet();
    const std::uint64_t passed_us = gateway_->now_us() - begin_us;
    if (answers ? controller_.report().sync_counter == controller_.sync_counter()
                : passed_us >= period_us)
      return;
    if (passed_us > kAnswerTimeout_us)
      throw UserError("the compensation node does not answer any more");
    gateway_->wait(kWait_us);
  }
}

void BusAxes::bring_up(double timeout_s) {
  controller_.power_on(bus_.now_us());
  const auto most = static_cast<std::uint64_t>(timeout_s / period_s());
  const std::vector<std::int32_t> path = on_wire(target_);
  for (std::uint64_t i = 0; i < most; ++i) {
    run_cycle(path);
    if (controller_.motion_allowed() && !ramping()) {
      up_ = true;
      return;
    }
  }
  throw UserError("the machine on the bus does not start: " + controller_.trouble());
}

void BusAxes::cycle(const TargetsNm& target) {
  if (!up_) bring_up();
  target_ = target;
  run_cycle(on_wire(target));
  const std::string trouble = controller_.trouble();
  if (!trouble.empty()) throw UserError("the machine on the bus has stopped: " + trouble);
}

OffsetsNm BusAxes::offset_nm() const {
  OffsetsNm offsets{};
  for (std::size_t a = 0; a < kGroupAxes; ++a)
    offsets[a] = drive_[a]->offset_taken();
  return offsets;
}

Pose BusAxes::position() const {
  Pose q{};
  for (std::size_t a = 0; a < kGroupAxes; ++a)
    q[a] = drive_[a]->position_mm();
  return q;
}

Approach BusAxes::approach() const {
  Approach from{};
  for (std::size_t a = 0; a < kGroupAxes; ++a)
    from[a] = drive_[a]->approach();
  return from;
}

double BusAxes::following_error_nm() const {
  double worst = 0.0;
  for (const auto& drive : drive_) {
    worst =
        std::max(worst, std::abs(static_cast<double>(drive->demand()) - drive->position_units()));
  }
  return worst;
}

bool BusAxes::ramping() const { return (controller_.report().any_status & kRamping) != 0; }

namespace {

BusSettings with_correction(BusSettings settings, CorrectionFile correction, double cycle_hz) {
  correction.tick_hz = cycle_hz;
  settings.limits = compensator_settings(correction);
  return settings;
}

}  // namespace

CellFactory loopback_cells(const MachineFile& machine, double cycle_hz) {
  const BusSettings settings = bus_settings(machine, cycle_hz);
  return [settings, cycle_hz](const TrueMachine& truth, const CorrectionFile& correction,
                              const std::vector<std::uint8_t>& image) {
    return std::make_unique<MotionCell>(
        truth, std::make_unique<BusAxes>(with_correction(settings, correction, cycle_hz), image));
  };
}

CellFactory gateway_cells(const MachineFile& machine, double cycle_hz, CanGateway& gateway) {
  const BusSettings settings = bus_settings(machine, cycle_hz);
  return [settings, cycle_hz, &gateway](const TrueMachine& truth, const CorrectionFile& correction,
                                        const std::vector<std::uint8_t>& image) {
    return std::make_unique<MotionCell>(
        truth,
        std::make_unique<BusAxes>(with_correction(settings, correction, cycle_hz), image, gateway));
  };
}

}  // namespace volcomp::sim
