#pragma once
// A simulated CiA 402 servo drive with its axis: a CANopen device on one side, a position in the
// world on the other. Nothing but CAN frames passes between it and its controller.
//
//   Cia402Drive drive(settings);
//   drive.power_on(now);
//   for (;;) canopen::exchange(drive, port, now);
//
// At SYNC the latest 607Ah and 60B0h take effect together, the axis moves on by one servo period,
// and 6064h, 6041h and 60B0h as they are then go out with the TPDOs. Between and without SYNC the
// servo clock runs on: a drive that loses its controller still brakes.
//
// The way of a servo period is known when it has been gone: an edge of the probe is given to the
// drive after the SYNC that ends the period, and before anybody fetches the answers to that SYNC.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "firmware/canopen/device.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"
#include "host_sim/sim/drives/cia402_axis.hpp"
#include "host_sim/sim/drives/cia402_state_machine.hpp"
#include "host_sim/sim/drives/drive_behaviour.hpp"
#include "host_sim/sim/drives/drive_profile.hpp"

namespace volcomp::sim {

class Cia402Drive;
using Cia402Device = canopen::Device<Cia402Drive>;

class Cia402Drive final {
 public:
  // How a drive counts.
  struct Units {
    double mm_per_unit = 1e-6;                       // linear
    double units_per_turn = kDriveUnitsPerTurn;      // rotary
    double presliding = 2000.0;                      // way of reversal: 2 µm
    std::uint32_t position_unit = host::kNanometre;  // 60A8h of a linear axis
  };
  // Positions in units: 1 nm of a linear, 2⁻³¹ turn of a rotary axis if `units` is left as it is.
  struct Settings {
    std::uint8_t node_id = 1;                    // 1…127
    bool rotary = false;                         // positions wrap, software limits do not apply
    double period_s = 0.001;                     // servo period, whole µs up to 255 ms
    double time_constant_s = 0.002;              // of the first-order position loop
    std::int32_t software_min = INT32_MIN;       // 607Dh:01
    std::int32_t software_max = INT32_MAX;       // 607Dh:02
    std::uint32_t following_window = 5'000'000;  // 6065h
    std::uint16_t following_timeout_ms = 0;      // 6066h
    std::uint32_t deceleration = 2'000'000'000;  // 6085h, units/s²: 2 m/s² or 0.93 turn/s²
    std::uint32_t feed_per_turn = 10'000'000;    // 6092h:01, linear axes: a 10 mm screw
    std::int64_t latch_delay_ns = 0;             // from an edge of the probe to its latch, ≥ 0
    std::int64_t latch_resolution_ns = 20;       // instants of latches are multiples of this
    Units units{};
    // Times 60B0h in 6062h while the drive is not enabled: no data sheet tells.
    std::int32_t offset_in_idle_demand = 0;
    std::shared_ptr<const DriveProfile> profile{};  // none: every object of cia402.def
    // 608Fh, 6091h, 6092h and 60A8h were stored in the drive for this axis; else those of a profile
    // are as its data sheet has them.
    bool scaled_for_axis = false;
    DriveBehaviour behaviour{};
  };

  // What the position loop takes in at a SYNC.
  struct InputStep {
    std::int32_t target = 0;           // 607Ah
    std::int32_t offset = 0;           // 60B0h
    std::int32_t previous_offset = 0;  // 60B0h at the SYNC before
    std::uint8_t sync_counter = 0;
  };

  explicit Cia402Drive(const Settings& settings);
  Cia402Drive(const Cia402Drive&) = delete;
  Cia402Drive& operator=(const Cia402Drive&) = delete;
  ~Cia402Drive() = default;

  [[nodiscard]] Cia402Device& device() { return device_; }
  [[nodiscard]] const host::Cia402Objects& objects() const { return objects_; }
  [[nodiscard]] host::PowerState power_state() const { return machine_.state(); }

  // As of canopen::Device, so that canopen::exchange() can serve a drive. poll() also runs the
  // servo periods that no SYNC has started: call it, not the one of the device.
  void receive(const hal::CanFrame& frame, std::uint64_t now_us) {
    if (powered_ && !refuse_dummy(frame) && !refuse_length(frame)) device_.receive(frame, now_us);
  }
  void poll(std::uint64_t now_us);
  [[nodiscard]] bool offer(hal::CanFrame& frame, std::uint64_t now_us);
  void taken(std::uint64_t now_us);
  // As of canopen::DeviceBase, for SimulatedBus::attach_resting().
  [[nodiscard]] bool heeds(const hal::CanFrame& frame) const { return device_.heeds(frame); }
  [[nodiscard]] std::uint64_t sends_at_us() const { return refusal_ ? 0 : device_.sends_at_us(); }
  [[nodiscard]] std::uint64_t rests_until_us() const;

  // Without power the axis stands at once (brake) and the drive sends nothing. Afterwards the
  // reading is where it was, but the position is not referenced and every object has its default,
  // 60B0h = 0.
  void power_off();
  void power_on(std::uint64_t now_us);
  [[nodiscard]] bool powered() const { return powered_; }

  // The axis is put somewhere, at rest; its reading moves along.
  void stand_at(std::int64_t units);
  // The axis is another one from now on, see Cia402Axis.
  void couple(ForeignMechanics mechanics);
  // It is a drive that behaves so from now on.
  void behave(const DriveBehaviour& behaviour) { settings_.behaviour = behaviour; }
  // Bit 8 of the statusword falls; the axis can be homed again.
  void lose_reference();
  // The probe signal changes, `time_ns` (≥ 0) after the begin of the servo period that the axis has
  // just gone. The latch comes latch_delay_ns later, where the axis was then; if that is beyond the
  // period, it belongs to the next one.
  void probe_edge(bool rising, std::int64_t time_ns);
  // Servo periods gone so far.
  [[nodiscard]] std::uint64_t periods() const { return periods_; }

  // Where the axis really is, counted through.
  [[nodiscard]] double position_units() const { return axis_.position_units(); }
  [[nodiscard]] double position_mm() const {
    return position_units() * settings_.units.mm_per_unit;
  }  // linear
  [[nodiscard]] double position_turns() const {
    return position_units() / settings_.units.units_per_turn;
  }
  [[nodiscard]] double approach() const { return axis_.approach(); }  // −1…+1
  // The target of the drive, counted through from its own zero (607Ch), and its 60B0h at the last
  // SYNC.
  [[nodiscard]] std::int64_t demand() const { return demand_; }
  [[nodiscard]] std::int32_t offset_taken() const { return offset_taken_; }

  // Called at every SYNC whose target and offset the position loop follows.
  std::function<void(const InputStep&)> on_input;

 private:
  friend Cia402Device;
  [[nodiscard]] bool refuse_dummy(const hal::CanFrame& frame);
  [[nodiscard]] bool refuse_length(const hal::CanFrame& frame);
  void reset_application();
  void reset_communication();
  void state_changed(canopen::NmtState state, std::uint64_t now_us);
  void sync(std::uint8_t counter, std::uint64_t now_us);
  void received(const canopen::Pdo& pdo, std::uint64_t now_us);
  void sent(std::size_t /*transmit_pdo*/) {}
  void due(std::uint64_t /*now_us*/) {}
  void background(std::uint64_t /*now_us*/) {}
  void time_of_day(std::uint32_t /*midnight_ms*/, std::uint16_t /*days*/) {}
  bool heartbeat(std::uint8_t node, canopen::HeartbeatEvent event, std::uint64_t now_us);
  void bad_sync(canopen::SyncVerdict /*verdict*/, std::uint64_t /*now_us*/) {}
  canopen::AbortCode before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes);
  void written(canopen::ObjectId object, std::uint64_t now_us);
  void before_read(canopen::ObjectId object);
  // There is no domain.
  static canopen::AbortCode read_domain(canopen::ObjectId object, Span<const std::uint8_t>& source);
  static canopen::AbortCode begin_domain(canopen::ObjectId object, std::size_t announced,
                                         Span<std::uint8_t>& sink);
  static canopen::AbortCode finish_domain(canopen::ObjectId object, std::size_t size);
  void abandon_domain(canopen::ObjectId /*object*/) {}

  [[nodiscard]] host::OperationMode mode() const;
  [[nodiscard]] bool in_cyclic_position() const;
  [[nodiscard]] bool stays_in_quick_stop() const;
  [[nodiscard]] std::int32_t on_wire(std::int64_t units) const;
  [[nodiscard]] bool possible(canopen::ObjectId object, std::int64_t value) const;

  void configure(std::vector<canopen::Pdo>& pdos,
                 const std::vector<canopen::PdoParameters>& parameters, canopen::PdoKind kind);
  void object_changed(std::uint16_t index);
  void control();
  void change_mode();
  void home_here();
  void abort_connection();
  void fail(canopen::ErrorCode code);

  void hold();
  void await_target();
  void take_target();
  void take_input(std::uint8_t sync_counter);
  void follow_at_once();
  [[nodiscard]] std::int64_t wanted() const;
  [[nodiscard]] std::int64_t within_software_limits(std::int64_t wanted);
  void run_servo_period();
  void latch_edges();
  void move();
  void brake();
  void supervise();
  void publish();
  [[nodiscard]] std::uint16_t statusword() const;
  [[nodiscard]] std::uint16_t mode_bits() const;

  struct Edge {
    bool rising;
    std::int64_t latch_ns;  // since the begin of the last period
  };

  Settings settings_;
  std::uint64_t period_us_;
  host::Cia402Objects objects_{};
  std::vector<canopen::PdoParameters> default_receive_;
  std::vector<canopen::PdoParameters> default_transmit_;
  std::vector<canopen::Pdo> receive_;
  std::vector<canopen::Pdo> transmit_;
  Cia402Device device_;
  PowerStateMachine machine_;
  Cia402Axis axis_;

  std::int64_t demand_ = 0;
  std::int32_t offset_taken_ = 0;
  std::int32_t target_taken_ = 0;              // 607Ah in force, or what was made of a missing one
  std::optional<std::int32_t> target_before_;  // 607Ah before that
  std::int32_t target_step_ = 0;               // between the two
  std::uint8_t targets_missed_ = 0;            // in a row
  std::uint64_t last_period_us_ = 0;           // when the last servo period began
  std::uint64_t periods_ = 0;
  std::uint64_t large_error_us_ = 0;  // how long the following error has been above 6065h
  std::vector<Edge> edges_;           // not latched yet
  std::uint16_t last_controlword_ = 0;
  bool powered_ = false;
  bool operational_ = false;     // NMT
  bool target_arrived_ = false;  // a 607Ah since the position loop was closed
  bool target_fresh_ = false;    // and since the last SYNC
  bool limited_ = false;
  bool referenced_ = false;
  bool homing_attained_ = false;
  bool home_offset_given_ = false;
  canopen::ErrorCode fault_ = canopen::ErrorCode::none;
  std::optional<hal::CanFrame> refusal_;  // an SDO answer in place of the device's
  bool offered_refusal_ = false;
};

}  // namespace volcomp::sim
