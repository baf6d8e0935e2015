#include "host_sim/sim/drives/cia402_drive.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "firmware/canopen/device.inl"

namespace volcomp::sim {
namespace {

constexpr std::uint32_t kServoDrive = 0x0002'0192;  // 1000h: CiA 402, servo drive
constexpr std::uint32_t kProductCode = 402;

template <std::size_t N>
void set_text(std::array<char, N>& text, std::string_view value) {
  std::copy_n(value.begin(), std::min(value.size(), N), text.begin());
}

canopen::CommunicationObjects default_communication(const Cia402Drive::Settings& settings) {
  canopen::CommunicationObjects c;
  c.device_type = kServoDrive;
  set_text(c.device_name, "volcomp simulated drive");
  set_text(c.hardware_version, "none");
  set_text(c.software_version, "1");
  c.product_code = kProductCode;
  c.serial_number = settings.node_id;
  return c;
}

// 60C2h: the fewest digits that hold the period, as exactly as its two bytes can.
void set_cycle(host::Cia402Objects& objects, std::uint64_t period_us) {
  std::int8_t exponent = -6;
  while (period_us > UINT8_MAX || (period_us != 0 && period_us % 10 == 0)) {
    period_us /= 10;
    ++exponent;
  }
  objects.cycle_value = static_cast<std::uint8_t>(period_us);
  objects.cycle_exponent = exponent;
}

void set_scaling(host::Cia402Objects& o, const Cia402Drive::Settings& settings) {
  const std::uint32_t turn =
      settings.rotary ? static_cast<std::uint32_t>(std::lround(settings.units.units_per_turn))
                      : settings.feed_per_turn;
  o.encoder_resolution = {turn, 1};
  o.gear = {1, 1};
  o.feed = {turn, 1};
  o.position_unit = settings.rotary ? host::kIncrement : settings.units.position_unit;
}

host::Cia402Objects default_objects(const Cia402Drive::Settings& settings,
                                    std::uint64_t period_us) {
  host::Cia402Objects o;
  o.following_window = settings.following_window;
  o.software_limit = {settings.software_min, settings.software_max};
  o.quick_stop_deceleration = settings.deceleration;
  set_scaling(o, settings);
  set_cycle(o, period_us);
  if (settings.profile) settings.profile->fill_application(o, settings.node_id);
  if (settings.scaled_for_axis) set_scaling(o, settings);
  return o;
}

canopen::Dictionary dictionary_of(const Cia402Drive::Settings& settings) {
  return settings.profile ? settings.profile->dictionary() : host::cia402_dictionary();
}

template <std::size_t N>
std::vector<canopen::PdoParameters> list_of(const std::array<canopen::PdoParameters, N>& pdos) {
  return {pdos.begin(), pdos.end()};
}

std::vector<canopen::PdoParameters> receive_pdos_of(const Cia402Drive::Settings& settings) {
  return settings.profile ? settings.profile->pdos(canopen::PdoKind::receive, settings.node_id)
                          : list_of(host::cia402_receive_pdos(settings.node_id));
}

std::vector<canopen::PdoParameters> transmit_pdos_of(const Cia402Drive::Settings& settings) {
  return settings.profile ? settings.profile->pdos(canopen::PdoKind::transmit, settings.node_id)
                          : list_of(host::cia402_transmit_pdos(settings.node_id));
}

}  // namespace

Cia402Drive::Cia402Drive(const Settings& settings)
    : settings_(settings),
      period_us_(static_cast<std::uint64_t>(std::llround(settings.period_s * 1e6))),
      default_receive_(receive_pdos_of(settings)),
      default_transmit_(transmit_pdos_of(settings)),
      receive_(default_receive_.size()),
      transmit_(default_transmit_.size()),
      device_({dictionary_of(settings),
               &objects_.communication,
               {receive_.data(), receive_.size()},
               {transmit_.data(), transmit_.size()}},
              *this),
      axis_(settings.period_s, settings.time_constant_s, settings.units.presliding) {
  device_.set_node_id(settings.node_id);
}

void Cia402Drive::power_on(std::uint64_t now_us) {
  powered_ = true;
  last_period_us_ = now_us;
  device_.power_on(now_us);
}

void Cia402Drive::power_off() {
  powered_ = false;
  operational_ = false;
  edges_.clear();
  machine_.power_on();
  axis_.stand();
  demand_ = axis_.reading();
}

void Cia402Drive::stand_at(std::int64_t units) {
  axis_.stand_at(units);
  hold();
}

void Cia402Drive::couple(ForeignMechanics mechanics) {
  axis_.couple(std::move(mechanics));
  hold();
}

void Cia402Drive::hold() {
  demand_ = axis_.reading();
  target_arrived_ = false;
  publish();
}

void Cia402Drive::lose_reference() {
  referenced_ = homing_attained_ = false;
  publish();
}

// A SYNC up to half a period late still starts its own period; only then does the clock go on
// without it.
void Cia402Drive::poll(std::uint64_t now_us) {
  if (!powered_) return;
  while (now_us - last_period_us_ >= period_us_ + period_us_ / 2) {
    last_period_us_ += period_us_;
    run_servo_period();
  }
  device_.poll(now_us);
}

std::uint64_t Cia402Drive::rests_until_us() const {
  if (!powered_) return UINT64_MAX;
  if (refusal_) return 0;
  return std::min(device_.rests_until_us(), last_period_us_ + period_us_ + period_us_ / 2);
}

void Cia402Drive::reset_application() {
  const canopen::CommunicationObjects communication = objects_.communication;
  objects_ = default_objects(settings_, period_us_);
  objects_.communication = communication;
  machine_.power_on();
  axis_.stand();
  demand_ = axis_.reading();
  offset_taken_ = 0;
  last_controlword_ = 0;
  edges_.clear();
  operational_ = target_arrived_ = target_fresh_ = limited_ = false;
  target_taken_ = 0;
  referenced_ = homing_attained_ = home_offset_given_ = false;
  fault_ = canopen::ErrorCode::none;
}

// What an EDS maps against its own rules stays unmapped.
void Cia402Drive::configure(std::vector<canopen::Pdo>& pdos,
                            const std::vector<canopen::PdoParameters>& parameters,
                            canopen::PdoKind kind) {
  for (std::size_t i = 0; i < pdos.size(); ++i)
    static_cast<void>(pdos[i].configure(parameters[i], kind, device_.objects()));
}

void Cia402Drive::reset_communication() {
  objects_.communication = default_communication(settings_);
  if (settings_.profile) settings_.profile->fill_communication(objects_, settings_.node_id);
  configure(receive_, default_receive_, canopen::PdoKind::receive);
  configure(transmit_, default_transmit_, canopen::PdoKind::transmit);
}

void Cia402Drive::state_changed(canopen::NmtState state, std::uint64_t) {
  machine_.initialised();
  const bool was_operational = operational_;
  operational_ = state == canopen::NmtState::operational;
  if (was_operational && !operational_) abort_connection();
  publish();
}

// Any watched node: without its controller the axis has no target, without the compensation it is
// in the wrong place.
bool Cia402Drive::heartbeat(std::uint8_t, canopen::HeartbeatEvent event, std::uint64_t) {
  if (event != canopen::HeartbeatEvent::lost) return true;
  abort_connection();
  publish();
  return true;
}

void Cia402Drive::abort_connection() {
  switch (static_cast<host::AbortConnection>(objects_.abort_connection)) {
    case host::AbortConnection::nothing:
      break;
    case host::AbortConnection::fault:
      fail(host::kCommunicationErrorCode);
      break;
    case host::AbortConnection::disable_voltage:
      machine_.command(PowerCommand::disable_voltage, stays_in_quick_stop());
      break;
    case host::AbortConnection::stop:
      machine_.command(PowerCommand::quick_stop, stays_in_quick_stop());
      break;
  }
}

void Cia402Drive::fail(canopen::ErrorCode code) {
  if (fault_ != canopen::ErrorCode::none) return;
  fault_ = code;
  objects_.error_code = static_cast<std::uint16_t>(code);
  device_.emergency().raise(code, 0);
  machine_.fail();
  if (objects_.fault_option == host::kFaultOff) machine_.standstill(stays_in_quick_stop());
}

}  // namespace volcomp::sim

namespace volcomp::canopen {

template class Device<sim::Cia402Drive>;

}  // namespace volcomp::canopen
