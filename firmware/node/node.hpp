#pragma once
// The compensation node: a CANopen device that listens to what motion controller and drives tell
// each other, and sends every drive the offset 60B0h that makes the tool point stand where the
// controller meant it.
//
// One cycle: SYNC n comes; controller and drives send their process data; when all of it is there,
// or at the deadline, the compensator ticks and the offsets leave in the same cycle; the drives
// take them together with 607Ah at SYNC n + 1. What is missing at the deadline is stale: the axis
// is held, then ramped down, the others go on.
//
// Like the Device inside it, the node does no input or output of its own; see canopen/device.hpp
// for the loop around it. Everything is allocated statically; no call blocks.
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

#include "firmware/canopen/device.hpp"
#include "firmware/node/node_objects.hpp"
#include "firmware/node/offset_gate.hpp"
#include "firmware/node/preemption.hpp"
#include "firmware/node/probe/probe_path.hpp"
#include "firmware/node/store/storage.hpp"
#include "firmware/node/strokes/stroke_service.hpp"
#include "firmware/node/tables/node_compensator.hpp"
#include "firmware/node/tables/table_download.hpp"
#include "firmware/node/thermal/thermal_service.hpp"
#include "firmware/node/wire_scale.hpp"
#include "hal/reset_cause.hpp"

namespace volcomp::node {

using hal::ResetCause;

// Room for all that is stored of the object dictionary, and for the learned tables.
inline constexpr std::size_t kParameterBytes =
    kWatchesStrokes ? 2560 + kMostLearnedBytes + kMostLearnedBytes / 32 : 2048;

class Node final : private canopen::Application {
 public:
  // `storage` may be nullptr: 1010h and 1011h then refuse. `node_id` 1…127. `preemption` may be
  // nullptr: then there is one context.
  explicit Node(std::uint8_t node_id, Storage* storage, Preemption* preemption = nullptr);
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  ~Node() = default;

  // A start that was not meant is told by an emergency.
  void power_on(std::uint64_t now_us, ResetCause cause = ResetCause::power_on);
  void receive(const hal::CanFrame& frame, std::uint64_t now_us) { device_.receive(frame, now_us); }
  // Its parts, see canopen/device.hpp.
  [[nodiscard]] canopen::Device::Work work(const hal::CanFrame& frame) const {
    return device_.work(frame);
  }
  void receive_cyclic(const hal::CanFrame& frame, std::uint64_t now_us) {
    device_.receive_cyclic(frame, now_us);
  }
  void receive_service(const hal::CanFrame& frame, std::uint64_t now_us) {
    device_.receive_service(frame, now_us);
  }
  // At least every millisecond: deadlines, heartbeats, SDO timeouts, temperatures, the scrub of the
  // tables.
  void poll(std::uint64_t now_us) {
    poll_services(now_us);
    poll_cycle(now_us);
    poll_probe();
    if constexpr (kWatchesStrokes) poll_strokes();
    poll_scrub(now_us);
  }
  // Its parts: what waits for others, what is due at a time of its own, what takes long.
  void poll_services(std::uint64_t now_us) { device_.poll_services(now_us); }
  void poll_cycle(std::uint64_t now_us);
  void poll_probe();
  void poll_strokes();
  void poll_scrub(std::uint64_t now_us);
  [[nodiscard]] bool offer(hal::CanFrame& frame, std::uint64_t now_us) {
    return device_.offer(frame, now_us);
  }
  void taken(std::uint64_t now_us) { device_.taken(now_us); }
  // When poll() has something to do at the latest, while a cycle is open; UINT64_MAX otherwise.
  [[nodiscard]] std::uint64_t deadline_us() const {
    return cycle_open_ ? deadline_us_ : UINT64_MAX;
  }

  // --- for those who serve the node from two contexts; from the tick interrupt

  // Since the last call so many frames were lost before the node saw them; 0: none.
  void frames_lost(std::uint32_t count);
  // The background is overdue: corrections ramp to zero and stay there until tables are activated
  // again. Or it is back.
  void background_overdue(bool overdue);
  // No drive holds a correction of this node, or none can be changed any more.
  [[nodiscard]] bool at_rest() const;

  [[nodiscard]] const canopen::Device& device() const { return device_; }
  [[nodiscard]] const NodeObjects& objects() const { return objects_; }
  [[nodiscard]] const NodeCompensator& compensator() const { return compensator_; }

 private:
  // What has arrived in this cycle, a bit per axis.
  struct Arrived {
    std::uint32_t target = 0;
    std::uint32_t actual = 0;
    std::uint32_t held = 0;
    std::uint32_t latched = 0;
    std::uint32_t counted = 0;
    bool process_state = false;
  };

  void reset_application() override;
  void reset_communication() override;
  void state_changed(canopen::NmtState state, std::uint64_t now_us) override;
  void sync(std::uint8_t counter, std::uint64_t now_us) override;
  void received(const canopen::Pdo& pdo, std::uint64_t now_us) override;
  void time_of_day(std::uint32_t midnight_ms, std::uint16_t days) override;
  bool heartbeat(std::uint8_t node, canopen::HeartbeatEvent event, std::uint64_t now_us) override;
  void bad_sync(canopen::SyncVerdict verdict, std::uint64_t now_us) override;
  canopen::AbortCode before_write(canopen::ObjectId object, const canopen::Entry& entry,
                                  Span<const std::uint8_t> bytes) override;
  void written(canopen::ObjectId object, std::uint64_t now_us) override;
  void before_read(canopen::ObjectId object) override;
  canopen::AbortCode read_domain(canopen::ObjectId object,
                                 Span<const std::uint8_t>& source) override;
  canopen::AbortCode begin_domain(canopen::ObjectId object, std::size_t announced,
                                  Span<std::uint8_t>& sink) override;
  canopen::AbortCode finish_domain(canopen::ObjectId object, std::size_t size) override;
  void abandon_domain(canopen::ObjectId object) override;

  Status scrub();

  // --- cycle (node_cycle.cpp)
  [[nodiscard]] bool uses(std::size_t axis) const { return objects_.drive[axis] != 0; }
  [[nodiscard]] bool complete() const;
  [[nodiscard]] std::uint64_t deadline_after_sync_us() const;
  void compute(std::uint64_t now_us);
  bool start_compensating();
  void take_inputs();
  [[nodiscard]] AxisSample sample(std::size_t axis);
  [[nodiscard]] std::uint32_t correcting_axes() const;  // that take offsets of any kind
  void send_offset(std::size_t axis, std::int32_t learned);
  void report_status();
  void report_axis_errors(std::size_t axis, std::uint16_t status);
  void raise_if(bool present, canopen::ErrorCode code, std::size_t axis, std::uint16_t status);

  // --- probe (node_probe.cpp)
  [[nodiscard]] bool probes() const;
  void end_probe_cycle(std::uint8_t next_counter);
  [[nodiscard]] LatchReport latch_report(std::size_t axis, bool consecutive) const;
  canopen::AbortCode switch_probe(ProbeCommand command);
  [[nodiscard]] canopen::AbortCode release_point(std::uint32_t sequence);
  void point_made();

  // --- strokes (node_strokes.cpp); only where kWatchesStrokes
  std::int32_t tick_strokes();
  [[nodiscard]] bool learns_for(std::size_t axis) const;
  [[nodiscard]] StrokeAxisReport stroke_report(std::size_t axis) const;
  void restart_strokes();
  void stop_strokes();
  bool report_strokes(const Status& status);
  canopen::AbortCode switch_strokes(StrokeCommand command);
  canopen::AbortCode learn(LearnCommand command);
  void read_strokes(std::uint16_t index);
  canopen::AbortCode read_stroke_domain(canopen::ObjectId object, Span<const std::uint8_t>& source);
  canopen::AbortCode begin_learned(std::size_t announced, Span<std::uint8_t>& sink);
  canopen::AbortCode finish_learned(std::size_t size);
  [[nodiscard]] Span<const std::uint8_t> learned_image();
  void load_learned(Span<const std::uint8_t> piece, std::size_t& size);
  void load_strokes(std::size_t learned_size);

  // --- temperatures and date (node_thermal.cpp); only where kFollowsTemperature
  void poll_thermal(std::uint64_t now_us);
  void complain_if(bool wrong, canopen::ErrorCode code, std::uint8_t source, std::uint8_t detail);

  // --- settings (node_settings.cpp)
  Status configure();
  void configure_gates();
  void set_default_pdos();
  void start_at_given_offsets();
  canopen::AbortCode run_table_command(TableCommand command);

  // --- store (node_store.cpp)
  canopen::AbortCode run_store(Span<const std::uint8_t> signature);
  canopen::AbortCode run_restore(Span<const std::uint8_t> signature);
  StoreResult save_record(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image);
  StoreResult erase_records();
  canopen::AbortCode report_store(StoreResult result);
  void load_stored(bool application);
  std::size_t collect_parameters();
  void apply_parameters(Span<const std::uint8_t> stored, bool application);
  void apply_pdo(std::uint16_t index, Span<const std::uint8_t> value);

  NodeObjects objects_{};
  std::array<canopen::Pdo, kReceivePdos> receive_{};
  std::array<canopen::Pdo, kTransmitPdos> transmit_{};
  Preemption* preemption_;
  canopen::Device device_;
  NodeCompensator compensator_{};
  TableDownload download_;
  ProbePath probe_;
  struct NoStrokes {
    NoStrokes(const NoStrokeObjects& /*objects*/, const Preemption* /*preemption*/) {}
  };
  std::conditional_t<kWatchesStrokes, StrokeService, NoStrokes> strokes_;
  std::conditional_t<kFollowsTemperature, ThermalService, NoThermalService> thermal_;
  Storage* storage_;

  PerAxis<OffsetGate> gate_{};
  PerAxis<WireScale> scale_{};
  PerAxis<WirePosition> position_{};
  Arrived arrived_{};
  PerAxis<std::int32_t> previous_actual_{};  // of the cycle before
  std::uint32_t had_actual_ = 0;             // a bit per axis
  bool touch_rejected_ = false;              // the last one
  TickInput<kNodeAxes> input_{};
  TickOutput<kNodeAxes> output_{};
  std::uint64_t deadline_us_ = 0;
  std::uint64_t next_scrub_us_ = 0;
  std::uint32_t syncs_missed_ = 0;         // when the last cycle was computed
  std::uint8_t open_counter_ = 0;          // of the SYNC that opened the cycle
  bool cycle_open_ = false;                // SYNC has come, not yet computed
  bool running_ = false;                   // the compensator ticks
  bool overdue_ = false;                   // the background
  PerAxis<std::uint16_t> clean_cycles_{};  // without trouble, per axis
  std::uint16_t clean_syncs_ = 0;          // since the last bad SYNC
  ResetCause reset_cause_ = ResetCause::power_on;
  std::uint32_t start_given_ = 0;  // 2206h written since the last start, a bit per axis
  std::array<std::uint8_t, kParameterBytes> parameters_{};  // as stored
};

}  // namespace volcomp::node
