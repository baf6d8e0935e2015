#include "tests/system/forwarded/old_target.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "firmware/canopen/cob_id.hpp"
#include "tests/system/bus_world.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint32_t kWindow_nm = 1'000'000;  // 6065h
constexpr std::uint16_t kShutdown = 0x06;        // 6040h
constexpr std::uint16_t kSwitchOn = 0x07;
constexpr std::uint16_t kEnable = 0x0F;
constexpr int kDisabled = 50;  // cycles
constexpr int kWatched = 500;
constexpr double kPeriod_s = 1e-6 * kForwardedPeriod_us;

host::BusSettings forwarded_settings() {
  host::BusSettings settings = bus_machine_settings();
  for (host::BusAxis& axis : settings.axes)
    axis.way = node::Way::forwarded_target;
  return settings;
}

DriveKind kind_of(const OldTarget& way) {
  DriveKind kind;
  kind.behaviour.at_enabling = DriveBehaviour::AtEnabling::keeps_target;
  kind.controlword_at_once = way.controlword_at_once;
  kind.watches_node = false;
  kind.following_window = kWindow_nm;
  kind.following_timeout_ms = way.following_timeout_ms;
  return kind;
}

// An axis with so much force; without a call it stands.
struct Heavy {
  double place_nm = kForwardedBegin_nm;
  double speed = 0.0;  // nm per period

  void follow(std::int64_t demand_nm, double most) {
    const double way = static_cast<double>(demand_nm) - place_nm;
    const double wanted = std::copysign(std::sqrt(2.0 * most * std::abs(way)), way);
    speed += std::clamp(wanted - speed, -most, most);
    place_nm += speed;
  }
};

void couple(Cia402Drive& drive, const std::shared_ptr<Heavy>& axis, double mm_per_s2) {
  const double most = 1e6 * mm_per_s2 * kPeriod_s * kPeriod_s;
  drive.couple({[axis] { return std::llround(axis->place_nm); },
                [axis, most](std::int64_t demand) { axis->follow(demand, most); }});
}

void silence_node(ForwardedWorld& world, OldTarget::Node how) {
  if (how == OldTarget::Node::serves) return;
  if (how == OldTarget::Node::dead) return world.power_node(false);
  // 2037h:01 = 255 by SDO.
  const auto request =
      static_cast<std::uint16_t>(canopen::kSdoRequest + world.controller().settings().node);
  world.send({request, 8, {0x2F, 0x37, 0x20, 0x01, 0xFF}});
}

void run(ForwardedWorld& world, int cycles) {
  for (int i = 0; i < cycles; ++i)
    world.cycle({});
}

}  // namespace

AfterEnabling enable_with_old_target(const OldTarget& way) {
  const DriveKind kind = kind_of(way);
  ForwardedWorld world(1, forwarded_settings(), {kind, kind, kind}, {});
  Cia402Drive& drive = world.drive(0);
  const auto heavy = std::make_shared<Heavy>();
  if (way.most_acceleration_mm_per_s2 > 0.0) couple(drive, heavy, way.most_acceleration_mm_per_s2);
  if (!world.bring_up()) throw std::runtime_error(world.controller().trouble());
  run(world, kDisabled);
  world.command(kShutdown);
  run(world, kDisabled);
  silence_node(world, way.node);
  run(world, kDisabled);
  heavy->place_nm += 1e6 * kMovedByHand_mm;
  heavy->speed = 0.0;
  drive.stand_at(std::llround(drive.position_units() + 1e6 * kMovedByHand_mm));
  const double begin = drive.position_units();
  if (way.careless) {
    run(world, 1);
    world.command(kSwitchOn);
    run(world, 3);
    world.command(kEnable);
  } else {
    world.command({});
  }
  AfterEnabling after;
  for (int i = 0; i < kWatched; ++i) {
    run(world, 1);
    after.moved_mm = std::max(after.moved_mm, 1e-6 * std::abs(drive.position_units() - begin));
    after.enabled = after.enabled || drive.objects().error_code != 0 ||
                    drive.power_state() == host::PowerState::operation_enabled;
    after.faulted = after.faulted || drive.objects().error_code == 0x8611;
  }
  return after;
}

}  // namespace volcomp::sim
