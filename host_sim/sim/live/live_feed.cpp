#include "host_sim/sim/live/live_feed.hpp"

#include <algorithm>
#include <utility>

#include "comp/core/units.hpp"
#include "comp/tick/status_text.hpp"
#include "host_sim/host/bus/device_files/signal_names.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/sim/controller/tick_tables.hpp"

namespace volcomp::sim {
namespace {

using nlohmann::json;

constexpr std::size_t kHitsShown = 8;
constexpr double kDegreesPerRad = 180.0 / kPi;
constexpr std::uint64_t kLoadWindow_ns = 100'000'000;

// Positions in mm or degrees, offsets in µm or µrad.
double place(const AxisSnapshot& axis, double units) {
  return axis.rotary ? kDegreesPerRad * units / kUnitsPerRad : units / kNmPerMm;
}

double correction(const AxisSnapshot& axis) {
  const auto units = static_cast<double>(axis.offset);
  return axis.rotary ? 1e6 * units / kUnitsPerRad : kUmPerMm * units / kNmPerMm;
}

double encoder(const AxisSnapshot& axis) {
  return axis.rotary ? kDegreesPerRad * axis.position : axis.position;
}

json states_of(std::uint16_t status) {
  json names = json::array();
  for (unsigned bit = 0; bit < kStatusBits; ++bit) {
    if ((unsigned{status} >> bit & 1U) == 0) continue;
    std::string name = code(static_cast<StatusBit>(1U << bit));
    std::replace(name.begin(), name.end(), '_', ' ');
    names.push_back(name);
  }
  return names;
}

std::string name_of(const host::ValueNames& names, unsigned value) {
  for (const auto& [number, name] : names) {
    if (number == value) return name;
  }
  return "unknown";
}

std::string phase_name(std::uint8_t phase) {
  static constexpr std::array<const char*, 4> kNames{"silent", "being configured", "running",
                                                     "refused its configuration"};
  return phase < kNames.size() ? kNames.at(phase) : "unknown";
}

// Before and after, as in the report; null: it has none.
json result_of(const json& document) {
  for (const json& section : document.value("sections", json::array())) {
    if (section.value("id", "") == "before-after") return section;
  }
  return nullptr;
}

}  // namespace

// Counts for itself and takes the lock only where something is shown.
class LiveFeed::Machine final : public MachineObserver {
 public:
  Machine(LiveFeed& feed, std::size_t its_number) : number(its_number), feed_(feed) {}
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;
  ~Machine() override { feed_.take(*this, nullptr); }

  void cycle(const MachineSnapshot& snapshot) override {
    const std::uint64_t before = ticks.latches();
    ticks.cycle(snapshot);
    if (++hidden_ < feed_.every_ && ticks.latches() == before) return;
    hidden_ = 0;
    feed_.take(*this, &snapshot);
  }

  const std::size_t number;  // from 1
  MachineTicks ticks;
  std::array<std::uint64_t, host::kMostAxes> latches{};  // as shown

 private:
  LiveFeed& feed_;
  std::uint32_t hidden_ = 0;  // periods since one was shown
};

LiveFeed::LiveFeed(std::string command, std::string transport, std::uint32_t every)
    : command_(std::move(command)), transport_(std::move(transport)), every_(every) {}

std::unique_ptr<MachineObserver> LiveFeed::enter() {
  const std::lock_guard lock(mutex_);
  ticks_.enter();
  return std::make_unique<Machine>(*this, ticks_.machines());
}

void LiveFeed::take(Machine& machine, const MachineSnapshot* now) {
  const std::lock_guard lock(mutex_);
  ticks_.take(machine.ticks);
  if (now == nullptr) return;
  note_hits(machine, *now);
  measure_load(machine, *now);
  last_ = *now;
  last_machine_ = machine.number;
}

void LiveFeed::note_hits(Machine& machine, const MachineSnapshot& now) {
  std::string letters;
  for (std::size_t a = 0; a < now.axes; ++a) {
    const AxisSnapshot& axis = now.axis[a];
    if (axis.latches > machine.latches[a]) {
      hit_count_ += axis.latches - machine.latches[a];
      letters += (letters.empty() ? "" : " ") + std::string(1, axis.letter);
    }
    machine.latches[a] = axis.latches;
  }
  if (letters.empty()) return;
  hits_.push_front({hit_count_, ticks_.machine_time_s(), letters, now});
  if (hits_.size() > kHitsShown) hits_.pop_back();
}

// Another machine has another bus, whose time begins again.
void LiveFeed::measure_load(const Machine& machine, const MachineSnapshot& now) {
  if (!now.bus) return;
  const BusState& bus = *now.bus;
  if (machine.number != last_machine_ || bus.now_ns < window_.now_ns) window_ = bus;
  const std::uint64_t passed = bus.now_ns - window_.now_ns;
  if (passed < kLoadWindow_ns) return;
  load_now_ = static_cast<double>(bus.busy_ns - window_.busy_ns) / static_cast<double>(passed);
  window_ = bus;
}

void LiveFeed::progress(double done, const std::string& what) {
  const std::lock_guard lock(mutex_);
  done_ = done;
  doing_ = what;
}

void LiveFeed::ended(const json& document, bool offered) {
  const std::lock_guard lock(mutex_);
  done_ = 1.0;
  phase_ = "ended";
  outcome_ = {{"title", document.value("title", "")},
              {"report", offered},
              {"verdict", document.value("verdict", json())},
              {"result", result_of(document)}};
}

void LiveFeed::failed(const std::string& why) {
  const std::lock_guard lock(mutex_);
  phase_ = "failed";
  outcome_ = {{"verdict", {{"ok", false}, {"text", why}}}};
}

json LiveFeed::axes() const {
  json axes = json::array();
  for (std::size_t a = 0; a < last_.axes; ++a) {
    const AxisSnapshot& axis = last_.axis[a];
    json shown = {{"axis", std::string(1, axis.letter)},
                  {"unit", axis.rotary ? "deg" : "mm"},
                  {"target", place(axis, static_cast<double>(axis.target))},
                  {"position", encoder(axis)},
                  {"correction", correction(axis)},
                  {"correction_unit", axis.rotary ? "µrad" : "µm"},
                  {"probe_edges", axis.latches},
                  {"drive", nullptr},
                  {"states", nullptr}};
    if (axis.drive_status) shown["drive"] = host::describe_drive(*axis.drive_status);
    if (axis.correction_status) shown["states"] = states_of(*axis.correction_status);
    axes.push_back(std::move(shown));
  }
  return axes;
}

json LiveFeed::bus() const {
  if (!last_.bus) return nullptr;
  const BusState& bus = *last_.bus;
  return {{"load_percent", 100.0 * load_now_},
          {"frames", bus.frames},
          {"emergencies", bus.emergencies},
          {"node", phase_name(bus.node_phase)},
          {"node_state", name_of(host::node_states(), bus.node_state)},
          {"states", states_of(bus.any_status)},
          {"active_tables_crc", bus.active_crc}};
}

json LiveFeed::hits() const {
  json hits = json::array();
  for (const Hit& hit : hits_) {
    json at = json::array();
    for (std::size_t a = 0; a < hit.machine.axes; ++a) {
      const AxisSnapshot& axis = hit.machine.axis[a];
      at.push_back({{"axis", std::string(1, axis.letter)},
                    {"position", encoder(axis)},
                    {"unit", axis.rotary ? "deg" : "mm"}});
    }
    hits.push_back({{"number", hit.number},
                    {"time_s", hit.time_s},
                    {"axes", hit.letters},
                    {"at", std::move(at)}});
  }
  return hits;
}

json LiveFeed::state() const {
  const std::lock_guard lock(mutex_);
  return {{"command", command_},
          {"transport", transport_},
          {"phase", phase_},
          {"progress", {{"done", done_}, {"what", doing_}}},
          {"outcome", outcome_},
          {"machine", ticks_.machines()},
          {"period", last_.cycle},
          {"time_s", ticks_.machine_time_s()},
          {"axes", axes()},
          {"bus", bus()},
          {"probe_edges", hit_count_},
          {"hits", hits()},
          {"ticks", tick_tables(ticks_)}};
}

}  // namespace volcomp::sim
