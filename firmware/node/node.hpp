#pragma once
// The compensation node: a CANopen device that listens to what motion controller and drives tell
// each other, and sends every drive the offset 60B0h that makes the tool point stand where the
// controller meant it.
//
// The loop around it (canopen/device.hpp) talks to the device, the device calls the handlers of the
// node, and the node is the list of its parts: each has what node_part.hpp names, in a folder of
// its own. All of it is bound at compile time and allocated statically; no call blocks.
//
// On a board two contexts share it (node_task.hpp): the tick interrupt works on the cycle, the
// background on the rest, with the tick kept out. Where the background lets the tick in, inside a
// Preemptible scope, these rules hold:
//   - The background touches only what the tick does not: the bytes of the image buffer, the spare
//     table set and the fold report in the compensator, the buffer of stored parameters, the
//     storage. The tick may read image bytes (an SDO upload is answered from them), so they are
//     written in such a scope only while the node is being reset.
//   - Everything else belongs to the tick there: objects, PDOs, emergencies, gates, the axes of the
//     compensator. What the background knew of it before the scope is stale after it, above all
//     whether the compensator runs.
//   - The tick receives cyclic frames only and leaves poll_services() alone: whatever could change
//     the state of the device or begin another SDO transfer waits for the end of the scope.
//   - While the node is being reset it is the other way round: everything belongs to the
//     background, and the tick finds a device that neither hears nor says anything.

#include "firmware/node/node_cycle.hpp"
#include "firmware/node/scrub_part.hpp"
#include "firmware/node/store/store_part.hpp"
#include "firmware/node/thermal/thermal_part.hpp"
#include "hal/can_port.hpp"
#include "hal/reset_cause.hpp"

namespace volcomp::node {

using hal::ResetCause;

class Node final {
 public:
  // `storage` may be nullptr: 1010h and 1011h then refuse. `node_id` 1…127. `preemption` may be
  // nullptr: then there is one context.
  explicit Node(std::uint8_t node_id, Storage* storage, Preemption* preemption = nullptr);
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  ~Node() = default;

  // Code and constants that the scrub also checks; before power_on(). None: nothing is checked.
  void watch_program(Span<const std::uint8_t> program) { scrub_.watch_program(program); }
  // Raises an emergency for a start that was not meant.
  void power_on(std::uint64_t now_us, ResetCause cause = ResetCause::power_on);

  // Takes frames and time, gives frames; `poll()` at least every millisecond.
  [[nodiscard]] NodeDevice& device() { return core_.device; }
  [[nodiscard]] const NodeDevice& device() const { return core_.device; }
  // When poll() has something to do at the latest, while a cycle is open; UINT64_MAX otherwise.
  [[nodiscard]] std::uint64_t deadline_us() const { return cycle_.deadline_us(); }
  // As that of the device (device_base.hpp), with all that the node does.
  [[nodiscard]] std::uint64_t rests_until_us() const;
  [[nodiscard]] const NodeObjects& objects() const { return core_.objects; }
  [[nodiscard]] const NodeCompensator& compensator() const { return core_.compensator; }

  // --- the background in three pieces, for a node that is served from two contexts

  void poll_probe() { probe_.background(0); }
  void poll_strokes() { strokes_.background(0); }
  // Also folds tables for the temperatures in use.
  void poll_scrub(std::uint64_t now_us);

  // --- from the tick interrupt

  // Since the last call so many frames were lost before the node saw them; 0: none.
  void frames_lost(std::uint32_t count);
  // The same for errors that the CAN controller has reported.
  void controller_errors(std::uint32_t count);
  // Axes whose drives take targets from this node, a bit each.
  [[nodiscard]] std::uint32_t forwarded_axes() const { return cycle_.forwarded_axes(); }
  // Of these, those whose last target was handed to the port and is not known to have been on the
  // bus; at every change, where the port tells.
  void unconfirmed(std::uint32_t axes) { cycle_.unconfirmed(axes); }
  // The port is gone, and with it what waited to leave: nothing is forwarded as if it had not been.
  void port_lost() {
    if (!core_.booting()) cycle_.end_forwarding();
  }
  // Every turn, where the port knows it: error passive and the way back from bus-off are
  // emergencies.
  void bus_state(hal::CanBusState state);
  // The background is overdue: corrections ramp to zero and stay there until tables are activated
  // again. Or it is back.
  void background_overdue(bool overdue);
  [[nodiscard]] bool at_rest() const { return core_.booting() || cycle_.at_rest(); }
  // A drive moves by the targets that this node forwards: it stops when the node does.
  [[nodiscard]] bool drives_follow() const { return !core_.booting() && cycle_.drives_follow(); }

 private:
  // --- handlers of the device
  friend NodeDevice;
  void reset_application();
  void reset_communication();
  void state_changed(canopen::NmtState state, std::uint64_t now_us);
  void sync(std::uint8_t counter, std::uint64_t now_us) { cycle_.sync(counter, now_us); }
  void received(const canopen::Pdo& pdo, std::uint64_t now_us);
  void sent(std::size_t transmit_pdo) { cycle_.sent(transmit_pdo); }
  void due(std::uint64_t now_us) { cycle_.due(now_us); }
  void background(std::uint64_t now_us);
  void time_of_day(std::uint32_t midnight_ms, std::uint16_t days) {
    thermal_.time_of_day(midnight_ms, days);
  }
  bool heartbeat(std::uint8_t node, canopen::HeartbeatEvent event, std::uint64_t now_us);
  void bad_sync(canopen::SyncVerdict verdict, std::uint64_t /*now_us*/) {
    cycle_.bad_sync(verdict);
  }
  canopen::AbortCode before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes);
  void written(canopen::ObjectId object, std::uint64_t now_us);
  void before_read(canopen::ObjectId object);
  canopen::AbortCode read_domain(canopen::ObjectId object, Span<const std::uint8_t>& source);
  canopen::AbortCode begin_domain(canopen::ObjectId object, std::size_t announced,
                                  Span<std::uint8_t>& sink);
  canopen::AbortCode finish_domain(canopen::ObjectId object, std::size_t size);
  void abandon_domain(canopen::ObjectId object);

  // Calls `visit` with each part. The cycle comes first: at a restart it configures the gates,
  // whose scales the others take.
  template <class Visit>
  void each_part(Visit visit) {
    visit(cycle_);
    visit(tables_);
    visit(probe_);
    visit(thermal_);
    visit(strokes_);
    visit(store_);
    visit(scrub_);
  }

  NodeCore core_;
  ProbePart probe_;
  StrokePart strokes_;
  NodeCycle cycle_;
  TableDownload tables_;
  ThermalPart thermal_;
  StorePart store_;
  ScrubPart scrub_;
  ResetCause reset_cause_ = ResetCause::power_on;
  bool bus_off_ = false;  // the CAN controller, when last looked at
};

}  // namespace volcomp::node
