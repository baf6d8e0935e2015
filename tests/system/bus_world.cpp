#include "tests/system/bus_world.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/xyfz/scenario.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"

namespace volcomp::sim {
namespace {

const Vec3 kStart{-250.0, -150.0, -200.0};
const Vec3 kBefore{-260.0, -160.0, -210.0};
constexpr int kSettle = 40;          // cycles without any change
constexpr int kLongest = 20'000;     // cycles for one journey
constexpr double kMargin_mm = 45.0;  // a quick stop from 400 mm/s takes 40 mm

// Tables that lead to other offsets everywhere.
MachineTables shifted(MachineTables tables) {
  constexpr float kShift_nm = 3000.0F;
  for (AxisTable& table : tables.axis) {
    for (auto& column : table.value) {
      for (Channels& knot : column)
        knot[0] += kShift_nm;
    }
  }
  ++tables.provenance.sequence;
  return tables;
}

BusMachine make_bus_machine() {
  BusMachine m;
  m.file = host::read_machine_file(host::bundled_machine("xyfz"));
  m.file.correction.tick_hz = kBusCycle_hz;
  m.truth = xyfz::make_xyfz_truth(m.file, xyfz::kXyfzMachineSeed,
                                  xyfz::tune_xyfz(m.file, xyfz::kXyfzMachineSeed));
  const Campaign campaign = perfect_campaign(m.truth, m.file);
  m.built = host::build_tables(campaign.machine, campaign.runs,
                               host::tables_only(host::ModelKind::abbe_closed));
  m.image = host::make_image(m.built->tables);
  m.other_image = host::make_image(shifted(m.built->tables));
  return m;
}

std::vector<std::int32_t> on_wire(const Vec3& mm) {
  std::vector<std::int32_t> wire;
  for (const double coordinate : mm)
    wire.push_back(static_cast<std::int32_t>(to_nm(coordinate)));
  return wire;
}

}  // namespace

const BusMachine& bus_machine() {
  static const BusMachine machine = make_bus_machine();
  return machine;
}

host::BusSettings bus_machine_settings(Drives drives) {
  host::BusSettings settings = host::bus_settings(bus_machine().file, kBusCycle_hz);
  for (host::BusAxis& axis : settings.axes)
    axis.reports_offset = drives != Drives::trust;
  if (drives == Drives::trust_first) settings.axes[0].reports_offset = false;
  return settings;
}

Intruder::Intruder(SimulatedBus& bus)
    : sdo_(bus_machine_settings().node), port_(&bus.attach(*this, "intruder")) {}

BusWorld::BusWorld(std::uint64_t seed, const std::vector<std::uint8_t>& image, Drives drives)
    : drives_(drives),
      random_(seed),
      axes_(bus_machine_settings(drives), image),
      intruder_(axes_.bus()),
      path_(on_wire(kStart)),
      goal_(path_) {
  for (std::size_t a = 0; a < kBusMachineAxes; ++a)
    watch(a);
  axes_.stand_at(host::pose_of(kStart));
  if (drives == Drives::confirm) axes_.bring_up();
  for (int i = 0; i < 6000 && !axes_.controller().motion_allowed(); ++i)
    step(goal_);
}

// Writes to a waiting node what a drive holds, one drive after the other. While its offsets are
// being sent the node refuses that.
void BusWorld::vouch() {
  constexpr std::uint64_t kCalm = 10;  // cycles: nothing is under way any more
  host::SdoChannel& sdo = intruder_.sdo();
  const bool asks = node().state == static_cast<std::uint8_t>(node::NodeState::waiting) ||
                    node().state == static_cast<std::uint8_t>(node::NodeState::degraded);
  if (drives_ == Drives::confirm || !asks || axes_.cycles() % kCalm != 0) return;
  sdo.clear();
  vouched_ = (vouched_ + 1) % kBusMachineAxes;
  const auto axis = static_cast<std::uint8_t>(vouched_ + 1);
  const auto held = static_cast<std::int32_t>(offsets()[vouched_]);
  sdo.write_value<std::int32_t>({0x2206, axis}, held, "offset a drive holds");
}

void BusWorld::watch(std::size_t axis) {
  const AxisLimits& limits = axes_.controller().settings().limits.axis[axis];
  axes_.drive(axis).on_input = [this, axis, limits](const Cia402Drive::InputStep& in) {
    ++inputs_;
    const std::int64_t step = std::abs(std::int64_t{in.offset} - in.previous_offset);
    largest_step_ = std::max(largest_step_, static_cast<std::int32_t>(step));
    const bool fine = step <= limits.rate && std::abs(in.offset) <= limits.limit;
    if (fine || !violation_.empty()) return;
    violation_ = fmt::format("cycle {}, axis {}: offset {} after {}", axes_.cycles(), axis,
                             in.offset, in.previous_offset);
  };
}

void BusWorld::choose_goal() {
  const DiagonalBox box = travel_box(bus_machine().file);
  Vec3 mm;
  for (Eigen::Index i = 0; i < 3; ++i)
    mm(i) = random_.uniform(box.lo(i) + kMargin_mm, box.hi(i) - kMargin_mm);
  goal_ = on_wire(mm);
  step_nm_ = static_cast<std::int32_t>(random_.uniform(1e3, 8e5));  // up to 400 mm/s
}

// An axis that does not follow is where it is; its path goes on from there.
void BusWorld::step(const std::vector<std::int32_t>& goal) {
  const bool moves = keep_moving_ || axes_.controller().motion_allowed();
  for (std::size_t a = 0; a < path_.size(); ++a) {
    const AxisCommander& axis = axes_.controller().axis(a);
    if (!axis.following()) path_[a] = axis.standing_at();
    if (axis.following() && moves)
      path_[a] += std::max(-step_nm_, std::min(goal[a] - path_[a], step_nm_));
  }
  axes_.run_cycle(path_);
  vouch();
}

void BusWorld::run(int cycles) {
  for (int i = 0; i < cycles; ++i) {
    if (at(goal_)) choose_goal();
    step(goal_);
  }
}

void BusWorld::stand(int cycles) {
  const std::vector<std::int32_t> here = path_;
  for (int i = 0; i < cycles; ++i)
    step(here);
}

bool BusWorld::go_to(const Vec3& mm) {
  const std::vector<std::int32_t> goal = on_wire(mm);
  step_nm_ = 400'000;
  int quiet = 0;
  for (int i = 0; i < kLongest && quiet < kSettle; ++i) {
    const host::Offsets before = offsets();
    step(goal);
    const bool still = at(goal) && offsets() == before && (node().any_status & kRamping) == 0;
    quiet = still ? quiet + 1 : 0;
  }
  return quiet == kSettle;
}

bool BusWorld::approach() { return go_to(kBefore) && go_to(kStart); }

std::string BusWorld::trouble() {
  if (std::string t = axes_.controller().trouble(); !t.empty()) return t;
  // What is on its way may be tables that are out of date already, and then the right ones.
  if (!axes_.controller().node().channel.idle()) return "the node is being given tables";
  if (node().state != static_cast<std::uint8_t>(node::NodeState::compensating))
    return fmt::format("node state {}", node().state);
  if (node().communication.error_register != 0)
    return fmt::format("error register {:02X}h", node().communication.error_register);
  return {};
}

bool BusWorld::recover(int most) {
  constexpr int kLastMessages = 50;  // cycles; EMCY have an inhibit time
  for (int i = 0; i < most; ++i) {
    run(1);
    if (!trouble().empty()) continue;
    run(kLastMessages);
    if (trouble().empty()) return true;
  }
  return false;
}

bool BusWorld::emergency(std::uint8_t node, std::uint16_t code) {
  const auto& all = axes_.controller().emergencies();
  return std::any_of(
      all.begin() + static_cast<std::ptrdiff_t>(mark_), all.end(),
      [node, code](const EmergencyRecord& e) { return e.node == node && e.code == code; });
}

std::string BusWorld::emergencies() {
  const auto& all = axes_.controller().emergencies();
  std::string text;
  for (std::size_t i = mark_; i < all.size(); ++i)
    text += fmt::format(" {}:{:04X}h({})", all[i].node, all[i].code, all[i].info[0]);
  return text;
}

}  // namespace volcomp::sim
