#pragma once
// Everything of a CANopen device that needs no application: its state, what it sends and when, the
// rules of the communication objects. Device adds what calls the application.

#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/communication_objects.hpp"
#include "firmware/canopen/emergency.hpp"
#include "firmware/canopen/heartbeat.hpp"
#include "firmware/canopen/nmt.hpp"
#include "firmware/canopen/pdo.hpp"
#include "firmware/canopen/sdo_server.hpp"
#include "firmware/canopen/sync.hpp"

namespace volcomp::canopen {

class DeviceBase {
 public:
  struct Parts {
    Dictionary dictionary;
    CommunicationObjects* values = nullptr;  // first member of the struct the dictionary describes
    Span<Pdo> receive;
    Span<Pdo> transmit;
    PdosOfCycle of_cycle{};
  };
  DeviceBase(const DeviceBase&) = delete;
  DeviceBase& operator=(const DeviceBase&) = delete;

  // Before power_on(): 1…127.
  void set_node_id(std::uint8_t id) { node_id_ = id; }
  [[nodiscard]] std::uint8_t node_id() const { return node_id_; }

  // What a frame may set off; each kind has a receive function of its own.
  enum class Work : std::uint8_t {
    cyclic,   // SYNC, process data, frames of others
    service,  // NMT command without reset, heartbeat: short, but may change the state of everything
    lengthy,  // SDO request, reset: as long as the application takes
  };
  [[nodiscard]] Work work(const hal::CanFrame& frame) const;

  // For a loop that serves many devices and skips those that have nothing to do (device_rest.cpp).
  // False: receive() of the device ignores the frame, whatever it contains.
  [[nodiscard]] bool heeds(const hal::CanFrame& frame) const;
  // From when on offer() has a frame, if nothing else happens: 0: now; UINT64_MAX: never.
  [[nodiscard]] std::uint64_t sends_at_us() const;
  // Before this time poll() and offer() of the device do nothing but what the application does,
  // unless it heeds a frame or another function is called. UINT64_MAX: for ever.
  [[nodiscard]] std::uint64_t rests_until_us() const;
  [[nodiscard]] bool offer(hal::CanFrame& frame, std::uint64_t now_us);

  static constexpr std::size_t kMostTransmit = 32;
  static constexpr std::size_t kMostReceive = 32;

  // The identifiers of all frames that do anything here, for a filter in front of the port: NMT,
  // SYNC, TIME, SDO requests, valid RPDOs, heartbeats of watched nodes. They change with 1005h,
  // 1016h and the PDOs.
  static constexpr std::size_t kMostHeard = 4 + kMostReceive + kHeartbeatConsumers;
  using HeardIds = std::array<std::uint16_t, kMostHeard>;
  [[nodiscard]] std::size_t heard(HeardIds& ids) const;

  [[nodiscard]] NmtState state() const { return state_; }
  [[nodiscard]] Emergency& emergency() { return emergency_; }
  [[nodiscard]] const Sync& sync() const { return sync_; }
  [[nodiscard]] const HeartbeatConsumer& heartbeats() const { return heartbeats_; }
  [[nodiscard]] PdoTable& pdos() { return pdos_; }
  [[nodiscard]] const PdoTable& pdos() const { return pdos_; }
  [[nodiscard]] const ObjectDictionary& objects() const { return objects_; }

  // Of the call that is being served.
  [[nodiscard]] std::uint64_t now_us() const { return now_us_; }
  // While held the device produces no heartbeat: for others it is lost.
  void hold_heartbeat(bool held) { heartbeat_held_ = held; }

  // Marks an event-driven TPDO (type 254, 255, or 0: at the next SYNC) as due.
  void trigger(std::size_t transmit_pdo);
  // The same for what happened before the last SYNC and is known only now: type 0 is sent at once,
  // among the answers to that SYNC.
  void trigger_belated(std::size_t transmit_pdo);
  // Cancels a TPDO that is due: its values are no longer true.
  void withdraw(std::size_t transmit_pdo);

 protected:
  enum class Offered : std::uint8_t { none, boot_up, sync, emergency, pdo, sdo, heartbeat };
  struct LatestFrame {
    hal::CanFrame frame{};
    bool waiting = false;
  };
  struct TransmitState {
    std::uint64_t last_us = 0;
    bool sent_any = false;
    std::uint8_t syncs = 0;
  };

  DeviceBase(const Parts& parts, ObjectAccess& access);
  ~DeviceBase() = default;

  // Notes the time of a call; false in boot-up, where the device neither receives nor sends.
  [[nodiscard]] bool enter_call(std::uint64_t now_us);
  [[nodiscard]] bool commanded(const hal::CanFrame& frame) const;
  void begin_restart();
  void end_restart(std::uint64_t now_us);
  // False: it is in that state already.
  [[nodiscard]] bool change_state(NmtState state);
  void fall_silent();
  // True: the process data are to be applied at once; false: they are too short, wait for SYNC, or
  // come after its window.
  [[nodiscard]] bool accept(std::size_t receive_pdo, const hal::CanFrame& frame,
                            std::uint64_t now_us);
  void run_own_timers(std::uint64_t now_us);
  void trigger_synchronous();
  void forget_invalid_pdos();
  void run_event_timers(std::uint64_t now_us);
  [[nodiscard]] bool inhibited(std::size_t pdo, std::uint64_t now_us) const;
  [[nodiscard]] bool offer_pdo(hal::CanFrame& frame, std::uint64_t now_us);
  // The state that 1029h asks for after a communication error.
  [[nodiscard]] NmtState state_after_error() const;

  AbortCode read_pdo(ObjectId object, Span<const std::uint8_t>& source);
  AbortCode copy_value(const ObjectDictionary::Found& found, Span<const std::uint8_t>& source);
  [[nodiscard]] AbortCode room_for(ObjectId object, const ObjectDictionary::Found& found,
                                   std::size_t announced, Span<std::uint8_t>& sink);
  [[nodiscard]] bool is_domain(ObjectId object) const;
  [[nodiscard]] AbortCode check_communication(ObjectId object,
                                              Span<const std::uint8_t> bytes) const;
  void communication_written(ObjectId object);

  CommunicationObjects& values_;
  ObjectDictionary objects_;
  PdoTable pdos_;
  Sync sync_;
  Emergency emergency_;
  HeartbeatConsumer heartbeats_;
  SdoServer sdo_;

  NmtState state_ = NmtState::boot_up;
  std::uint8_t node_id_ = 1;
  Offered offered_ = Offered::none;
  bool boot_up_due_ = false;
  bool heartbeat_due_ = false;
  bool heartbeat_held_ = false;
  bool sdo_waiting_ = false;
  bool sync_waiting_ = false;
  std::uint32_t pending_ = 0;   // TPDOs to send, a bit each
  std::uint32_t for_sync_ = 0;  // TPDOs of type 0 to send at the next SYNC
  std::size_t offered_pdo_ = 0;
  std::uint64_t now_us_ = 0;  // of the call being served
  std::uint64_t last_heartbeat_us_ = 0;
  std::uint64_t last_sync_us_ = 0;
  SdoData sdo_response_{};
  hal::CanFrame sync_frame_{};
  std::array<LatestFrame, kMostReceive> latest_{};  // synchronous RPDOs until their SYNC
  std::array<TransmitState, kMostTransmit> transmit_state_{};
  std::array<std::uint8_t, 64> scratch_{};  // of an SDO transfer of a plain object
};

}  // namespace volcomp::canopen
