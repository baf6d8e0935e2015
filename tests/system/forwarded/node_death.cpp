#include "tests/system/forwarded/node_death.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "comp/core/units.hpp"
#include "tests/system/bus_world.hpp"

namespace volcomp::sim {
namespace {

using Missing = DriveBehaviour::MissingTarget;

constexpr double kPeriod_s = 1e-6 * kForwardedPeriod_us;
constexpr std::uint8_t kTimerCycles = 3;
constexpr std::uint16_t kWatch_ms = 30;
constexpr std::uint16_t kHeartbeat_ms = 10;
constexpr std::uint16_t kQuickStop = 0x02;  // 6040h
constexpr int kRunUp = 200;                 // cycles from standstill to the feed
constexpr int kStands = 20;                 // cycles without motion
constexpr int kLongestStop = 2000;

host::BusSettings machine(const NodeDeath& death) {
  host::BusSettings settings = bus_machine_settings();
  settings.heartbeat_ms = kHeartbeat_ms;
  settings.axes[0].way = node::Way::forwarded_target;
  if (death.both_forwarded) settings.axes[1].way = node::Way::forwarded_target;
  return settings;
}

DriveKinds drives(const NodeDeath& death) {
  DriveKind kind;
  kind.behaviour.missing_target = death.missing;
  if (death.missing == Missing::fault) kind.behaviour.patience = 0;
  if (death.watch == DeathWatch::rpdo_timer) kind.behaviour.target_timer = kTimerCycles;
  kind.watches_node = death.watch == DeathWatch::heartbeat;
  kind.watch_ms = kWatch_ms;
  kind.deceleration = kDeathDeceleration;
  return {kind, kind, kind};
}

class Circle {
 public:
  explicit Circle(const NodeDeath& death)
      : death_(death), world_(1, machine(death), drives(death), {}) {
    if (!world_.bring_up()) throw std::runtime_error(world_.controller().trouble());
  }

  // At the feed after kRunUp cycles.
  void go_on() {
    const double share = std::min(1.0, static_cast<double>(++cycle_) / kRunUp);
    angle_ += share * death_.feed_m_per_s * kPeriod_s / (1e-3 * kDeathRadius_mm);
    const std::array<std::int32_t, 2> target{
        static_cast<std::int32_t>(to_nm(kDeathRadius_mm * std::sin(angle_))),
        static_cast<std::int32_t>(to_nm(kDeathRadius_mm * (1.0 - std::cos(angle_))))};
    world_.cycle({target[0] - target_[0], target[1] - target_[1], 0});
    target_ = target;
  }

  void kill_node() {
    if (death_.watch == DeathWatch::nobody) return world_.command(kQuickStop);
    world_.power_node(false);
    world_.pretend_node(death_.watch != DeathWatch::controller);
  }

  // An axis that has stopped stops the others.
  void watch_axes() {
    const bool both =
        world_.controller().axis(0).following() && world_.controller().axis(1).following();
    if (!both) world_.command(kQuickStop);
  }

  [[nodiscard]] double error_mm() {
    const double x = place(0);
    const double y = place(1) - kDeathRadius_mm;
    return std::abs(std::hypot(x, y) - kDeathRadius_mm);
  }
  // Of one axis from where it began, mm.
  [[nodiscard]] double place(std::size_t axis) {
    return 1e-6 * (world_.drive(axis).position_units() - kForwardedBegin_nm);
  }

 private:
  NodeDeath death_;
  ForwardedWorld world_;
  std::array<std::int32_t, 2> target_{};
  double angle_ = 0.0;
  int cycle_ = 0;
};

}  // namespace

int death_cycles(double feed_m_per_s) {
  return static_cast<int>(2.0 * kPi * 1e-3 * kDeathRadius_mm / (feed_m_per_s * kPeriod_s));
}

double path_error_mm(const NodeDeath& death, int cycle) {
  constexpr double kStill_mm = 1e-6;
  Circle circle(death);
  for (int i = 0; i < kRunUp + cycle; ++i)
    circle.go_on();
  circle.kill_node();
  double worst = 0.0;
  int still = 0;
  for (int i = 0; i < kLongestStop; ++i) {
    const std::array<double, 2> before{circle.place(0), circle.place(1)};
    circle.go_on();
    circle.watch_axes();
    worst = std::max(worst, circle.error_mm());
    const bool moves = std::abs(circle.place(0) - before[0]) > kStill_mm ||
                       std::abs(circle.place(1) - before[1]) > kStill_mm;
    still = moves ? 0 : still + 1;
    if (still == kStands) return worst;
  }
  throw std::runtime_error("the axes do not stop");
}

}  // namespace volcomp::sim
