#include "host_sim/sim/controller/bus_axes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/bus/drive_model.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint64_t kSyncPhase_ns = 300'000;  // after SYNC, before the targets are sent
constexpr std::size_t kGatewayMailboxes = 4096;
constexpr std::uint64_t kAnswerTimeout_us = 5'000'000;
constexpr std::uint32_t kWait_us = 200;
constexpr std::int64_t kWireUnit = 512;  // 2^-31 turn in run-time units

host::AxisKinds kinds_of(const host::BusSettings& settings) {
  host::AxisKinds kinds;
  kinds.count = settings.axes.size();
  for (std::size_t a = 0; a < kinds.count; ++a)
    kinds.rotary.at(a) = settings.axes[a].rotary;
  return kinds;
}

// 60A8h of a drive whose unit has `nm` nanometres: metres where that is a power of ten.
std::uint32_t position_unit(double nm) {
  const double power = std::log10(nm);
  if (std::abs(power - std::round(power)) > 1e-9) return host::kIncrement;
  const auto prefix = static_cast<std::uint8_t>(static_cast<int>(std::round(power)) - 9);
  return std::uint32_t{prefix} << 24U | (host::kNanometre & 0x00FF'0000U);
}

// Converts the settings of a drive to the units of this axis; the machine stays the same.
void apply_drive_units(const host::BusAxis& axis, Cia402Drive::Settings& s) {
  s.scaled_for_axis = s.profile != nullptr;
  const auto& other = axis.counts_otherwise;
  const double size =
      other ? static_cast<double>(other->numerator) / other->denominator : host::unit_size(axis);
  const double usual = axis.rotary ? 512.0 : 1.0;
  if (!(size < usual || size > usual)) return;
  const double more = usual / size;  // units of the drive in a default one
  const auto scaled = [more](std::uint32_t value) {
    return static_cast<std::uint32_t>(std::clamp(std::round(value * more), 1.0, 4294967295.0));
  };
  s.following_window = scaled(s.following_window);
  s.deceleration = scaled(s.deceleration);
  s.units.presliding *= more;
  if (axis.rotary) {
    s.units.units_per_turn *= more;
  } else {
    s.units.mm_per_unit = size / kNmPerMm;
    s.units.position_unit = s.profile ? host::kIncrement : position_unit(size);
    if (s.profile) s.feed_per_turn = scaled(s.feed_per_turn);
  }
}

host::BusSettings lock_step(host::BusSettings settings) {
  constexpr std::uint32_t kDeadline_us = 60'000'000;
  settings.deadline_us = kDeadline_us;
  settings.status_every_cycle = true;
  settings.heartbeat_timeout_ms = 30'000;
  return settings;
}

}  // namespace

BusAxes::BusAxes(const host::BusSettings& settings, const std::vector<std::uint8_t>& image,
                 hal::FrameLength length)
    : period_us_(settings.period_us),
      bus_(length),
      controller_(settings, image),
      node_(std::make_unique<node::Node>(settings.node, nullptr)) {
  build(settings);
  node_port_ = &bus_.attach_resting(node_->device(), "node",
                                    [node = node_.get()] { return node->rests_until_us(); });
  node_->power_on(0);
}

BusAxes::BusAxes(const host::BusSettings& settings, const std::vector<std::uint8_t>& image,
                 CanGateway& gateway)
    : period_us_(settings.period_us), controller_(lock_step(settings), image), gateway_(&gateway) {
  build(settings);
  gateway_port_ = &bus_.attach_served("gateway", {}, kGatewayMailboxes);
}

void BusAxes::build(const host::BusSettings& settings) {
  if (settings.axes.empty() || settings.axes.size() > host::kMostAxes)
    throw host::UserError(fmt::format("the simulated bus takes 1 to {} axes, the machine has {}",
                                      host::kMostAxes, settings.axes.size()));
  controller_port_ = &bus_.attach_resting(controller_, "controller",
                                          [this] { return controller_.rests_until_us(); });
  for (const host::BusAxis& axis : settings.axes) {
    Cia402Drive::Settings s;
    s.node_id = axis.drive;
    s.rotary = axis.rotary;
    s.period_s = period_s();
    s.time_constant_s = kDriveTimeConstant_s;
    s.latch_delay_ns = axis.latch_delay_ns;
    if (axis.model) s.profile = std::make_shared<const DriveProfile>(axis.model->eds());
    apply_drive_units(axis, s);
    attach(s, fmt::format("drive {}", axis.letter));
  }
}

void BusAxes::serve_drive(std::size_t a, std::uint64_t now_us) {
  Cia402Drive& drive = *drive_[a];
  drive_rest_[a].serve(drive, *drive_port_[a], now_us, bus_.served(),
                       [&drive] { return drive.rests_until_us(); });
}

void BusAxes::attach(const Cia402Drive::Settings& settings, const std::string& name) {
  Cia402Drive& drive = *drive_.emplace_back(std::make_unique<Cia402Drive>(settings));
  const std::size_t a = drive_.size() - 1;
  drive_rest_.emplace_back();
  const auto serve = [this, a](SimulatedBus::Port& port, std::uint64_t now_us) {
    if (probe_) {
      serve_drives(now_us);
      return std::uint64_t{0};
    }
    drive_rest_[a].receive(*drive_[a], port, now_us);
    serve_drive(a, now_us);
    return drive_rest_[a].until_us();
  };
  drive_port_.push_back(&bus_.attach_served(name, serve));
  drive_port_.back()->set_filter(
      [&drive](const hal::CanFrame& frame) { return drive.heeds(frame); });
  drive.power_on(0);
}

namespace {

// A turn has 2^40 run-time units: in two halves of 20 bits, as one product would overflow.
std::int64_t units_of_turn(std::int64_t run_time_units, std::uint32_t per_turn) {
  constexpr std::int64_t kHalf = std::int64_t{1} << 20U;
  const std::int64_t high = run_time_units / kHalf;
  const std::int64_t low = run_time_units % kHalf;
  return std::llround(
      (static_cast<double>(high * per_turn) + static_cast<double>(low * per_turn) / kHalf) / kHalf);
}

}  // namespace

// The nearest unit of the drive.
std::int64_t BusAxes::drive_units(std::size_t a, std::int64_t run_time_units) const {
  const host::BusAxis& axis = controller_.settings().axes[a];
  if (axis.units_per_turn != 0) return units_of_turn(run_time_units, axis.units_per_turn);
  const std::int64_t scaled = run_time_units * axis.scale_denominator;
  const std::int64_t half = axis.scale_numerator / 2;
  return (scaled + (scaled < 0 ? -half : half)) / axis.scale_numerator;
}

std::vector<std::int32_t> BusAxes::on_wire(const host::Targets& target) const {
  std::vector<std::int32_t> wire;
  wire.reserve(drive_.size());
  for (std::size_t a = 0; a < drive_.size(); ++a) {
    const std::int64_t units = drive_units(a, target[a]);
    const bool rotary = controller_.settings().axes[a].rotary;
    if (!rotary && saturated(units) != units)
      throw host::UserError(fmt::format("{} nm is beyond the 32 bits of 607Ah", target[a]));
    wire.push_back(wrapped(units));
  }
  return wire;
}

void BusAxes::couple(std::size_t a, ForeignMechanics mechanics) {
  const host::BusAxis& axis = controller_.settings().axes.at(a);
  const std::int64_t finer = axis.rotary ? kWireUnit : 1;
  const double size = host::unit_size(axis) / static_cast<double>(finer);
  drive_.at(a)->couple({[this, a, finer, read = std::move(mechanics.read)] {
                          return drive_units(a, finer * read());
                        },
                        [size, follow = std::move(mechanics.follow)](std::int64_t demand) {
                          follow(std::llround(static_cast<double>(demand) * size));
                        }});
}

void BusAxes::stand_at(const Pose& pose) {
  if (up_) throw std::logic_error("axes on a bus cannot be put elsewhere while they run");
  target_ = kinds_of(controller_.settings()).targets(pose);
  for (std::size_t a = 0; a < drive_.size(); ++a)
    drive_[a]->stand_at(drive_units(a, target_[a]));
  felt_ = {position(), approach()};
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
  sent_.assign(path.begin(), path.end());
  const auto period_ns = static_cast<std::uint64_t>(std::llround(period_us_ * 1000.0));
  next_sync_ns_ += period_ns;
  bus_.run_until(next_sync_ns_);
  if (gateway_ != nullptr) await_node();
  next_sync_ns_ = std::max(next_sync_ns_, bus_.bus().now_ns());
  controller_.send_sync();
  bus_.run_until(next_sync_ns_ + kSyncPhase_ns, *controller_port_);
  ++cycles_;
  show();
}

void BusAxes::watch(MachineWatch& watch) {
  std::string letters;
  for (const host::BusAxis& axis : controller_.settings().axes)
    letters += axis.letter;
  AxisGroup::watch(watch, letters, kinds_of(controller_.settings()));
}

void BusAxes::add_states(MachineSnapshot& snapshot) const {
  for (std::size_t a = 0; a < drive_.size(); ++a) {
    snapshot.axis[a].drive_status = controller_.axis(a).status_word();
    if (node_) snapshot.axis[a].correction_status = node_->objects().status[a];
  }
  const NodeReport& report = controller_.report();
  BusState bus;
  bus.now_ns = bus_.bus().now_ns();
  bus.busy_ns = bus_.bus().busy_ns();
  bus.frames = bus_.bus().frames();
  bus.emergencies = controller_.emergencies().size();
  bus.node_phase = static_cast<std::uint8_t>(controller_.node().phase);
  bus.node_state = report.state;
  bus.any_status = report.any_status;
  bus.active_crc = report.active_crc;
  if (node_) {
    bus.deadline_missed = node_->objects().deadline_missed;
    bus.sync_missed = node_->objects().sync_missed;
  }
  snapshot.bus = bus;
}

// A node that is OPERATIONAL answers every SYNC. Its first status PDO shows that it is (CiA 301,
// 7.3.2.2: no process data before), and an emulated node on a busy computer sends its next
// heartbeat many cycles later.
bool BusAxes::node_answers() {
  const Station& node = controller_.node();
  const bool running = node.phase == Station::Phase::running;
  const bool operational = node.state == canopen::NmtState::operational;
  const bool stopped = was_operational_ && !operational;
  was_operational_ = operational;
  const std::uint64_t reports = controller_.report().count;
  if (!running || stopped) reports_before_start_ = reports;
  return running && reports > reports_before_start_;
}

// A node that forwards targets takes a SYNC without counter for a foreign one when it comes less
// than half a period after the last.
std::uint64_t BusAxes::shortest_cycle_us() const {
  const host::BusSettings& settings = controller_.settings();
  return host::forwards_targets(settings) && host::sync_counter_overflow(settings) == 0
             ? static_cast<std::uint64_t>(std::llround(0.75 * period_us_))
             : 0;
}

// Lock step while the node answers every cycle; before that, its own time.
void BusAxes::await_node() {
  const std::uint64_t begin_us = gateway_->now_us();
  const auto period_us = static_cast<std::uint64_t>(std::llround(period_us_));
  const std::uint64_t shortest_us = shortest_cycle_us();
  const bool answers = node_answers();
  while (true) {
    bus_.run_until_quiet();
    gateway_->exchange(*gateway_port_);
    bus_.run_until_quiet();
    const std::uint64_t passed_us = gateway_->now_us() - begin_us;
    const bool answered = controller_.sync_answered() && passed_us >= shortest_us;
    if (answers ? answered : passed_us >= period_us) return;
    if (passed_us > kAnswerTimeout_us)
      throw host::UserError("the compensation node does not answer any more");
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
  throw host::UserError("the machine on the bus does not start: " + controller_.trouble());
}

void BusAxes::cycle(const host::Targets& target) {
  if (!up_) bring_up();
  target_ = target;
  run_cycle(on_wire(target));
  const std::string trouble = controller_.trouble();
  if (!trouble.empty()) throw host::UserError("the machine on the bus has stopped: " + trouble);
}

host::Offsets BusAxes::offset() const {
  host::Offsets offsets{};
  for (std::size_t a = 0; a < drive_.size(); ++a) {
    const host::BusAxis& axis = controller_.settings().axes[a];
    double units = drive_[a]->offset_taken();
    // In the target that the drive took at the last SYNC.
    if (axis.way != host::Way::offset)
      units = sent_.empty() ? 0 : wrapped(drive_[a]->demand() - sent_.at(a));
    offsets[a] = std::llround(units * host::unit_size(axis));
  }
  return offsets;
}

Pose BusAxes::position() const {
  Pose q{};
  for (std::size_t a = 0; a < drive_.size(); ++a) {
    const bool rotary = controller_.settings().axes[a].rotary;
    q[a] = rotary ? 2.0 * kPi * drive_[a]->position_turns() : drive_[a]->position_mm();
  }
  return q;
}

Approach BusAxes::approach() const {
  Approach from{};
  for (std::size_t a = 0; a < drive_.size(); ++a)
    from[a] = drive_[a]->approach();
  return from;
}

double BusAxes::following_error() const {
  double worst = 0.0;
  for (std::size_t a = 0; a < drive_.size(); ++a) {
    const host::BusAxis& axis = controller_.settings().axes[a];
    const double units =
        std::abs(static_cast<double>(drive_[a]->demand()) - drive_[a]->position_units());
    worst =
        std::max(worst, units * host::unit_size(axis) / (axis.rotary ? double{kWireUnit} : 1.0));
  }
  return worst;
}

double BusAxes::largest_unit_nm() const {
  double largest = 0.0;
  for (const host::BusAxis& axis : controller_.settings().axes) {
    if (!axis.rotary) largest = std::max(largest, host::unit_size(axis));
  }
  return largest;
}

bool BusAxes::ramping() const { return (controller_.report().any_status & kRamping) != 0; }

BusAxesFactory loopback_axes() {
  return [](const host::BusSettings& settings, const std::vector<std::uint8_t>& image) {
    return std::make_unique<BusAxes>(settings, image);
  };
}

BusAxesFactory gateway_axes(CanGateway& gateway) {
  return [&gateway](const host::BusSettings& settings, const std::vector<std::uint8_t>& image) {
    return std::make_unique<BusAxes>(settings, image, gateway);
  };
}

BusAxesFactory with_drives(BusAxesFactory make_axes, std::vector<std::string> names) {
  return [make_axes = std::move(make_axes), names = std::move(names)](
             const host::BusSettings& settings, const std::vector<std::uint8_t>& image) {
    return make_axes(host::with_models(settings, names), image);
  };
}

BusAxesFactory watched(BusAxesFactory make_axes, MachineWatch& watch) {
  return [make_axes = std::move(make_axes), &watch](const host::BusSettings& settings,
                                                    const std::vector<std::uint8_t>& image) {
    auto axes = make_axes(settings, image);
    axes->watch(watch);
    return axes;
  };
}

CellFactory bus_cells(const host::MachineFile& machine, double cycle_hz, BusAxesFactory make_axes) {
  return [machine, cycle_hz, make_axes = std::move(make_axes)](
             const TrueMachine& truth, const host::CorrectionFile& correction,
             const std::vector<std::uint8_t>& image) {
    host::MachineFile corrected = machine;
    corrected.correction = correction;
    return std::make_unique<MotionCell>(truth,
                                        make_axes(host::bus_settings(corrected, cycle_hz), image));
  };
}

}  // namespace volcomp::sim
