// Forwarded targets with drives of every behaviour, while everything goes wrong: what
// ForwardedJudge promises, and what a drive has without the node. The same with a drive that does
// as it is told is tests/firmware/node/forwarding_random_test.cpp, faster and longer; here the
// drives, their frames and a controller that starts everything again are real.
//
// VOLCOMP_SEQUENCES=1000 tries more, VOLCOMP_FIRST_SEQUENCE=n others.

#include <cstdlib>
#include <functional>

#include <gtest/gtest.h>

#include "firmware/canopen/cob_id.hpp"
#include "tests/system/bus_world.hpp"
#include "tests/system/forwarded/forwarded_twin.hpp"
#include "tests/system/forwarded/forwarded_world.hpp"

namespace volcomp::sim {
namespace {

using Kind = DriveEvent::Kind;
using Missing = DriveBehaviour::MissingTarget;
using AtEnabling = DriveBehaviour::AtEnabling;
using Acts = DriveBehaviour::TargetActs;
using Beyond = DriveBehaviour::BeyondLimit;

#ifdef NDEBUG
constexpr int kSequences = 48;  // every choice of behaviours once
#else
constexpr int kSequences = 6;
#endif
constexpr int kCycles = 1200;
constexpr std::uint16_t kShutdown = 0x06;  // 6040h

int number_from(const char* name, int otherwise) {
  const char* const wanted = std::getenv(name);
  return wanted == nullptr ? otherwise : static_cast<int>(std::strtol(wanted, nullptr, 10));
}
int sequences() { return number_from("VOLCOMP_SEQUENCES", kSequences); }
int first_sequence() { return number_from("VOLCOMP_FIRST_SEQUENCE", 0); }

// 2 × 3 × 2 × 2 × 2 × 3 settings by number; the axes of a machine differ.
DriveKind kind_of(std::uint64_t number) {
  const auto choose = [&number](std::uint64_t from) {
    const std::uint64_t choice = number % from;
    number /= from;
    return choice;
  };
  DriveKind kind;
  if (choose(2) == 1) kind.behaviour.at_enabling = AtEnabling::keeps_target;
  const std::uint64_t missing = choose(3);
  if (missing == 1) kind.behaviour.missing_target = Missing::extrapolated;
  if (missing == 2) kind.behaviour.missing_target = Missing::fault;
  if (choose(2) == 1) kind.behaviour.beyond_limit = Beyond::fault;
  kind.target_at_once = choose(2) == 1;
  if (kind.target_at_once) kind.behaviour.target_acts = Acts::at_reception;
  kind.controlword_at_once = choose(2) == 1;
  kind.watches_node = choose(3) == 0;
  return kind;
}

host::BusSettings forwarded_settings(std::int32_t slew, std::int32_t soft_rate) {
  host::BusSettings settings = bus_machine_settings();
  for (host::BusAxis& axis : settings.axes)
    axis.way = node::Way::forwarded_target;
  for (AxisLimits& axis : settings.limits.axis) {
    axis.rate = slew;
    axis.soft_rate = soft_rate;
  }
  return settings;
}

class Disorder {
 public:
  explicit Disorder(std::uint64_t number)
      : random_(7000 + number),
        world_(7000 + number, settings(), kinds(number), disorder()),
        rate_(random_.uniform(0.002, 0.02)) {}

  void run() {
    ASSERT_TRUE(world_.bring_up()) << world_.controller().trouble();
    world_.disturb();
    for (int i = 0; i < kCycles && world_.judge().violation().empty(); ++i) {
      if (random_.uniform() < rate_) happen();
      count_down();
      world_.cycle(steps());
    }
    ASSERT_EQ(world_.judge().violation(), "");
  }
  [[nodiscard]] const ForwardedWorld& world() const { return world_; }

 private:
  int some(int least, int most) { return static_cast<int>(random_.uniform(least, most + 1.0)); }
  std::size_t any_axis() { return static_cast<std::size_t>(some(0, kForwardedAxes - 1)); }

  // Software limits near where the axes begin, in half of the machines.
  host::BusSettings settings() {
    host::BusSettings s = forwarded_settings(some(0, 1) == 0 ? 700 : 20'000, some(20, 700));
    if (some(0, 1) == 0) s.axes[0].highest = -190'000'000;
    return s;
  }
  static DriveKinds kinds(std::uint64_t number) {
    return {kind_of(number), kind_of(number + 53), kind_of(number + 101)};
  }
  BusDisorder disorder() {
    if (some(0, 3) == 0) return {};
    return {random_.uniform(0.0, 0.1), random_.uniform(0.0, 0.1), random_.uniform(0.0, 0.05)};
  }

  std::array<std::int32_t, kForwardedAxes> steps() {
    for (std::int32_t& speed : speed_)
      speed = std::clamp(speed + some(-20'000, 20'000), -200'000, 200'000);
    return speed_;
  }

  // Undone after so many cycles.
  void later(int cycles, std::function<void()> undo) {
    pending_.push_back({cycles, std::move(undo)});
  }
  void count_down() {
    for (auto it = pending_.begin(); it != pending_.end();) {
      if (--it->cycles > 0) {
        ++it;
        continue;
      }
      const std::function<void()> undo = std::move(it->undo);
      it = pending_.erase(it);
      undo();
    }
  }

  void command(canopen::NmtCommand what, int node) {
    world_.send(
        {canopen::kNmt, 2, {static_cast<std::uint8_t>(what), static_cast<std::uint8_t>(node)}});
  }

  // Anything once begun ends before the next begins; frames are lost all the time.
  void happen() {
    if (!pending_.empty()) return;
    if (some(0, 1) == 0) return to_node();
    to_others();
  }

  void to_node() {
    switch (some(0, 6)) {
      case 0:
        world_.stall_node(true);
        return later(some(1, 40), [this] { world_.stall_node(false); });
      case 1:
        world_.power_node(false);
        return later(some(1, 40), [this] { world_.power_node(true); });
      case 2:
        world_.fill_node_port(true);
        return later(some(1, 10), [this] { world_.fill_node_port(false); });
      case 3:
        world_.deafen_node(true);
        return later(some(1, 5), [this] { world_.deafen_node(false); });
      case 4:
        world_.node().bus_state(hal::CanBusState::off);
        return world_.node().bus_state(hal::CanBusState::active);
      case 5:
        return world_.node().frames_lost(static_cast<std::uint32_t>(some(1, 3)));
      default:
        return command(canopen::NmtCommand::enter_pre_operational, 32);
    }
  }

  void to_others() {
    const std::size_t axis = any_axis();
    switch (some(0, 8)) {
      case 0:
        world_.silence_controller(true);
        return later(some(1, 60), [this] { world_.silence_controller(false); });
      case 1:
        return world_.restart_controller();
      case 2:
        world_.command(kShutdown);
        return later(some(1, 40), [this] { world_.command({}); });
      case 3:
        return second_sync();
      case 4:
        world_.to_drive(axis, Kind::deaf);
        return later(some(1, 5), [this, axis] { world_.to_drive(axis, Kind::hears); });
      case 5:
        world_.to_drive(axis, Kind::power_off);
        return later(some(5, 60), [this, axis] { world_.to_drive(axis, Kind::power_on); });
      case 6:
        world_.to_drive(axis, Kind::off_bus);
        return later(some(1, 40), [this, axis] { world_.to_drive(axis, Kind::on_bus); });
      case 7:
        return world_.to_drive(axis, Kind::lose_reference);
      default:
        return command(some(0, 1) == 0 ? canopen::NmtCommand::reset_node
                                       : canopen::NmtCommand::enter_pre_operational,
                       static_cast<int>(axis) + 1);
    }
  }

  void second_sync() {
    const std::uint8_t counter = world_.controller().sync_counter();
    world_.send({canopen::kSync, 1, {static_cast<std::uint8_t>((counter + 100) % 240 + 1)}});
  }

  struct Pending {
    int cycles;
    std::function<void()> undo;
  };
  Random random_;
  ForwardedWorld world_;
  double rate_;  // of events, per cycle
  std::vector<Pending> pending_;
  std::array<std::int32_t, kForwardedAxes> speed_{};
};

TEST(ForwardedInDisorder, KeepsItsPromisesWithEveryDrive) {
  std::uint64_t taken = 0;
  std::uint64_t corrected = 0;
  std::uint64_t switched_on = 0;
  std::uint64_t under_way = 0;
  std::uint64_t presumed = 0;
  for (int i = first_sequence(); i < first_sequence() + sequences(); ++i) {
    Disorder disorder(static_cast<std::uint64_t>(i));
    disorder.run();
    ASSERT_FALSE(HasFatalFailure()) << "sequence " << i;
    ASSERT_EQ(difference_without_node(disorder.world()), "") << "sequence " << i;
    const ForwardedJudge& judge = disorder.world().judge();
    taken += judge.taken();
    corrected += judge.corrected();
    switched_on += judge.switched_on();
    under_way += judge.under_way();
    presumed += judge.presumed();
  }
  const auto runs = static_cast<std::uint64_t>(sequences());
  RecordProperty("taken", static_cast<int>(taken));
  RecordProperty("corrected", static_cast<int>(corrected));
  RecordProperty("switched_on", static_cast<int>(switched_on));
  RecordProperty("under_way", static_cast<int>(under_way));
  RecordProperty("presumed", static_cast<int>(presumed));
  EXPECT_GT(taken, runs * 500) << "or nothing was tried";
  EXPECT_GT(corrected, runs * 300);
  EXPECT_GT(switched_on, runs * 5);
  EXPECT_LT(under_way * 10, switched_on) << "the node knows before";
  EXPECT_LE(presumed, runs / 4) << "two losses at once";
}

}  // namespace
}  // namespace volcomp::sim
