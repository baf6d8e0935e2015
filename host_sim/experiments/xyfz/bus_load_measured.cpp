// Measures the bus load: the simulated machine on a bus whose frames take the time of their
// contents.

#include "host_sim/experiments/xyfz/bus_load_measured.hpp"

#include <algorithm>
#include <limits>

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/experiments/xyfz/scenario.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"

namespace volcomp::xyfz {
namespace {

constexpr double kDuration_s = 2.0;

struct Workpiece {
  host::MachineFile file;
  sim::TrueMachine truth;
  std::vector<std::uint8_t> image;
};

Workpiece prepare() {
  Workpiece w;
  w.file = host::read_machine_file(host::bundled_machine("xyfz"));
  w.truth = make_xyfz_truth(w.file, kXyfzMachineSeed, {});
  const sim::Campaign campaign = sim::perfect_campaign(w.truth, w.file);
  w.image = host::make_image(host::build_tables(campaign.machine, campaign.runs, {})->tables);
  return w;
}

// When the last offset of a cycle was on the bus, after the SYNC that began it.
class OffsetTimer {
 public:
  void watch(sim::BusAxes& axes) {
    axes.bus().bus().set_observer([this](std::uint64_t time_ns, const hal::CanFrame& frame,
                                         const hal::LoopbackBus::Port& sender) {
      if (frame.id == canopen::kSync) sync_ns_ = time_ns;
      const bool offset = sender.name() == "node" && frame.size == 4;
      if (offset) worst_ns_ = std::max(worst_ns_, time_ns - sync_ns_);
    });
  }
  void begin() { worst_ns_ = 0; }
  [[nodiscard]] double worst_us() const { return 1e-3 * static_cast<double>(worst_ns_); }

 private:
  std::uint64_t sync_ns_ = 0;
  std::uint64_t worst_ns_ = 0;
};

host::MeasuredLoad measure(const Workpiece& w, double cycle_hz) {
  OffsetTimer timer;
  auto owned = std::make_unique<sim::BusAxes>(host::bus_settings(w.file, cycle_hz), w.image,
                                              hal::FrameLength::exact);
  sim::BusAxes& axes = *owned;
  timer.watch(axes);
  sim::MotionCell cell(w.truth, std::move(owned));
  const DiagonalBox box = sim::travel_box(w.file);
  cell.place(box.lo);

  const hal::LoopbackBus& bus = axes.bus().bus();
  const std::uint64_t begin_ns = bus.now_ns();
  const std::uint64_t busy_ns = bus.busy_ns();
  const std::uint64_t cycles = axes.cycles();
  const std::uint32_t missed = axes.node()->objects().deadline_missed;
  timer.begin();
  cell.move_to(box.hi, (box.hi - box.lo).norm() / kDuration_s);
  host::MeasuredLoad m;
  m.average =
      static_cast<double>(bus.busy_ns() - busy_ns) / static_cast<double>(bus.now_ns() - begin_ns);
  m.worst_offset_us = timer.worst_us();
  m.cycles = axes.cycles() - cycles;
  m.deadline_missed = axes.node()->objects().deadline_missed - missed;
  return m;
}

}  // namespace

std::vector<host::MeasuredLoad> measure_bus_load(const std::vector<double>& cycle_hz) {
  std::vector<host::MeasuredLoad> all;
  if (cycle_hz.empty()) return all;
  const Workpiece workpiece = prepare();
  for (const double rate : cycle_hz)
    all.push_back(measure(workpiece, rate));
  return all;
}

}  // namespace volcomp::xyfz
