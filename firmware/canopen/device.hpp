#pragma once
// A CANopen device without its application: NMT, heartbeat, SYNC, EMCY, PDOs and the SDO server,
// joined to one object dictionary. It does no input or output of its own: frames are handed in,
// frames to send are taken out, time is told. The same code therefore runs in a firmware, in a
// Linux process and ten at a time in a test.
//
//   device.power_on(now);
//   for (;;) {
//     while (port.receive(frame)) device.receive(frame, now);
//     device.poll(now);
//     while (device.offer(frame, now) && port.send(frame)) device.taken(now);
//   }
//
// What offer() shows may still change until it is taken: process data leave with their latest
// value, they are never queued.
//
// Before power_on() and while it is being reset (CiA 301, section 7.3.2.2.1: Initialisation) a
// device neither hears nor says anything.

#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/communication_objects.hpp"
#include "firmware/canopen/emergency.hpp"
#include "firmware/canopen/heartbeat.hpp"
#include "firmware/canopen/nmt.hpp"
#include "firmware/canopen/pdo.hpp"
#include "firmware/canopen/sdo_server.hpp"
#include "firmware/canopen/sync.hpp"

namespace volcomp::canopen {

// What a device is made for. Every member is called from within Device::receive or Device::poll.
class Application {
 public:
  // The values of the application area (and of the PDO parameters) become what they are after
  // power-on: defaults, then what was stored.
  virtual void reset_application() = 0;
  // The same for the communication area; ends with the device in PRE-OPERATIONAL.
  virtual void reset_communication() = 0;
  virtual void state_changed(NmtState state, std::uint64_t now_us) = 0;

  // A SYNC of this network in OPERATIONAL; synchronous RPDOs have taken effect, synchronous TPDOs
  // are gathered after the return.
  virtual void sync(std::uint8_t counter, std::uint64_t now_us) = 0;
  // Values of this RPDO have just been written.
  virtual void received(const Pdo& pdo, std::uint64_t now_us) = 0;
  // TIME (CiA 301, section 7.2.6): milliseconds after midnight, days since 1 January 1984.
  virtual void time_of_day(std::uint32_t /*midnight_ms*/, std::uint16_t /*days*/) {}
  // True when the loss of this node is a communication error in the sense of 1029h.
  virtual bool heartbeat(std::uint8_t node, HeartbeatEvent event, std::uint64_t now_us) = 0;
  // A second SYNC producer, or SYNC with the wrong length.
  virtual void bad_sync(SyncVerdict verdict, std::uint64_t now_us) = 0;

  // An SDO client wants to write: may refuse what only the application can judge.
  virtual AbortCode before_write(ObjectId object, const Entry& entry,
                                 Span<const std::uint8_t> bytes) = 0;
  virtual void written(ObjectId object, std::uint64_t now_us) = 0;
  // Values that are made only when somebody reads them.
  virtual void before_read(ObjectId object) = 0;
  virtual AbortCode read_domain(ObjectId object, Span<const std::uint8_t>& source) = 0;
  virtual AbortCode begin_domain(ObjectId object, std::size_t announced,
                                 Span<std::uint8_t>& sink) = 0;
  virtual AbortCode finish_domain(ObjectId object, std::size_t size) = 0;
  virtual void abandon_domain(ObjectId object) = 0;

 protected:
  Application() = default;
  Application(const Application&) = default;
  Application& operator=(const Application&) = default;
  ~Application() = default;
};

class Device final : private ObjectAccess {
 public:
  struct Parts {
    Dictionary dictionary;
    CommunicationObjects* values = nullptr;  // first member of the struct the dictionary describes
    Span<Pdo> receive;
    Span<Pdo> transmit;
    std::size_t timed = 0;  // first of `transmit` that only the application sends (PdoTable)
  };
  // Everything given must outlive the device.
  Device(const Parts& parts, Application& application);
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device() = default;

  // Before power_on(): 1…127.
  void set_node_id(std::uint8_t id) { node_id_ = id; }
  [[nodiscard]] std::uint8_t node_id() const { return node_id_; }

  void power_on(std::uint64_t now_us);
  void receive(const hal::CanFrame& frame, std::uint64_t now_us);
  // The parts of receive(), for those who serve a device from two contexts: what a frame may set
  // off, and the function for such frames only.
  enum class Work : std::uint8_t {
    cyclic,   // SYNC, process data, other people's frames
    service,  // NMT command without reset, heartbeat: short, but may change the state of everything
    lengthy,  // SDO request, reset: as long as the application takes
  };
  [[nodiscard]] Work work(const hal::CanFrame& frame) const;
  void receive_cyclic(const hal::CanFrame& frame, std::uint64_t now_us);
  void receive_service(const hal::CanFrame& frame, std::uint64_t now_us);
  void receive_lengthy(const hal::CanFrame& frame, std::uint64_t now_us);

  void poll(std::uint64_t now_us) {
    poll_services(now_us);
    poll_cycle(now_us);
  }
  // The two parts of poll(): what waits for others (SDO client, heartbeats heard), and what leaves
  // at a time of its own (SYNC, process data, own heartbeat).
  void poll_services(std::uint64_t now_us);
  void poll_cycle(std::uint64_t now_us);
  [[nodiscard]] bool offer(hal::CanFrame& frame, std::uint64_t now_us);
  void taken(std::uint64_t now_us);

  [[nodiscard]] NmtState state() const { return state_; }
  [[nodiscard]] Emergency& emergency() { return emergency_; }
  [[nodiscard]] const Sync& sync() const { return sync_; }
  [[nodiscard]] const HeartbeatConsumer& heartbeats() const { return heartbeats_; }
  [[nodiscard]] PdoTable& pdos() { return pdos_; }
  [[nodiscard]] const PdoTable& pdos() const { return pdos_; }
  [[nodiscard]] const ObjectDictionary& objects() const { return objects_; }

  // An event-driven TPDO (type 254, 255, or 0: at the next SYNC) has something to say.
  void trigger(std::size_t transmit_pdo);
  // The same for what happened before the last SYNC and comes to light only now: type 0 goes out at
  // once, among the answers to that SYNC.
  void trigger_belated(std::size_t transmit_pdo);
  // Takes the offer of a TPDO back: what it would say is no longer true.
  void withdraw(std::size_t transmit_pdo);
  // Writes one object as an SDO client would, with every check (parameter files, stored values).
  AbortCode write(ObjectId object, Span<const std::uint8_t> bytes);
  void enter(NmtState state, std::uint64_t now_us);

  static constexpr std::size_t kMostTransmit = 32;
  static constexpr std::size_t kMostReceive = 64;

 private:
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

  AbortCode begin_upload(ObjectId object, Span<const std::uint8_t>& source) override;
  AbortCode begin_download(ObjectId object, std::size_t announced,
                           Span<std::uint8_t>& sink) override;
  AbortCode finish_download(ObjectId object, std::size_t size) override;
  void abandon_download(ObjectId object) override;

  [[nodiscard]] bool hears(std::uint64_t now_us);
  [[nodiscard]] bool commanded(const hal::CanFrame& frame) const;
  void restart(bool application_too, std::uint64_t now_us);
  void fall_silent();
  void take_sync(const hal::CanFrame& frame, std::uint64_t now_us);
  void take_time(const hal::CanFrame& frame);
  void run_cycle(std::uint64_t now_us);
  void take_process_data(const hal::CanFrame& frame, std::uint64_t now_us);
  void take_process_data(std::size_t receive_pdo, const hal::CanFrame& frame, std::uint64_t now_us);
  void apply(const Pdo& pdo, const hal::CanFrame& frame, std::uint64_t now_us);
  void take_heartbeat(const hal::CanFrame& frame, std::uint64_t now_us);
  void watch_heartbeats(std::uint64_t now_us);
  void communication_error(std::uint64_t now_us);
  void trigger_synchronous();
  void forget_invalid_pdos();
  void run_event_timers(std::uint64_t now_us);
  [[nodiscard]] bool inhibited(std::size_t pdo, std::uint64_t now_us) const;
  [[nodiscard]] bool offer_pdo(hal::CanFrame& frame, std::uint64_t now_us);
  AbortCode check_communication(ObjectId object, Span<const std::uint8_t> bytes) const;
  void communication_written(ObjectId object);
  AbortCode store(ObjectId object, Span<const std::uint8_t> bytes);

  CommunicationObjects& values_;
  Application& application_;
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
