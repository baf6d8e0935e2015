#pragma once
// A CANopen device: NMT, heartbeat, SYNC, EMCY, PDOs and the SDO server, joined to one object
// dictionary, with the handlers of one application bound at compile time. It does no input or
// output of its own: frames are handed in, frames to send are taken out, the time is an argument.
// The same code therefore runs in a firmware, in a Linux process and ten at a time in a test.
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
// device neither receives nor sends.
//
// An application has these handlers, and Device as a friend; all are called from within receive(),
// poll(), taken() or write():
//
//   void reset_application()      the application area (and the PDO parameters) become what they
//                                 are after power-on: defaults, then what was stored
//   void reset_communication()    the same for the communication area; then PRE-OPERATIONAL
//   void state_changed(NmtState, now_us)
//   void sync(counter, now_us)    a SYNC in OPERATIONAL; synchronous RPDOs have taken effect,
//                                 synchronous TPDOs are gathered after the return
//   void received(const Pdo&, now_us)     values of this RPDO have just been written
//   void sent(transmit_pdo)       this TPDO has been handed to the port, with its present values
//   void due(now_us)              time has passed: deadlines of the cycle
//   void background(now_us)       time has passed: what may take long (poll() only)
//   void time_of_day(midnight_ms, days)   TIME (CiA 301, section 7.2.6), days since 1984-01-01
//   bool heartbeat(node, HeartbeatEvent, now_us)   true: the loss of this node is a communication
//                                 error in the sense of 1029h
//   void bad_sync(SyncVerdict, now_us)    a second SYNC producer, or SYNC with the wrong length
//   AbortCode before_write(ObjectId, bytes)   refuses what only the application can judge
//   void written(ObjectId, now_us)
//   void before_read(ObjectId)    for values that are made when they are read
//   AbortCode read_domain(ObjectId, Span<const std::uint8_t>& source)
//   AbortCode begin_domain(ObjectId, announced, Span<std::uint8_t>& sink)
//   AbortCode finish_domain(ObjectId, size)
//   void abandon_domain(ObjectId)
//
// The members are in device.inl. The file that defines the application includes it and has
// `template class Device<…>;`.

#include "firmware/canopen/device_base.hpp"

namespace volcomp::canopen {

template <class Application>
class Device final : private ObjectAccess, public DeviceBase {
 public:
  // Everything given must outlive the device.
  Device(const Parts& parts, Application& application)
      : DeviceBase(parts, *this), application_(application) {}
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device() = default;

  void power_on(std::uint64_t now_us);
  void receive(const hal::CanFrame& frame, std::uint64_t now_us);
  // The parts of receive(), one for each kind of Work, for a device that is served from two
  // contexts.
  void receive_cyclic(const hal::CanFrame& frame, std::uint64_t now_us);
  void receive_service(const hal::CanFrame& frame, std::uint64_t now_us);
  void receive_lengthy(const hal::CanFrame& frame, std::uint64_t now_us);

  // At least every millisecond.
  void poll(std::uint64_t now_us);
  // The parts of poll() before the background of the application: what waits for others (SDO
  // client, heartbeats of others), and what is due at a time of its own (SYNC, process data, own
  // heartbeat).
  void poll_services(std::uint64_t now_us);
  void poll_cycle(std::uint64_t now_us);
  void taken(std::uint64_t now_us);

  // Writes one object as an SDO client would, with every check (parameter files, stored values).
  AbortCode write(ObjectId object, Span<const std::uint8_t> bytes);
  void enter(NmtState state, std::uint64_t now_us);

 private:
  AbortCode begin_upload(ObjectId object, Span<const std::uint8_t>& source) override;
  AbortCode begin_download(ObjectId object, std::size_t announced,
                           Span<std::uint8_t>& sink) override;
  AbortCode finish_download(ObjectId object, std::size_t size) override;
  void abandon_download(ObjectId object) override;

  void restart(bool application_too, std::uint64_t now_us);
  void take_sync(const hal::CanFrame& frame, std::uint64_t now_us);
  void take_time(const hal::CanFrame& frame);
  void run_cycle(std::uint64_t now_us);
  void take_process_data(const hal::CanFrame& frame, std::uint64_t now_us);
  void apply(const Pdo& pdo, const hal::CanFrame& frame, std::uint64_t now_us);
  void take_heartbeat(const hal::CanFrame& frame, std::uint64_t now_us);
  void watch_heartbeats(std::uint64_t now_us);
  AbortCode store(ObjectId object, Span<const std::uint8_t> bytes);

  Application& application_;
};

}  // namespace volcomp::canopen
