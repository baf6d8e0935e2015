// Forwarded targets while everything goes wrong: random sequences of everything that can happen to
// bus, node, drives and controller, judged by ForwardingBench at every frame and every SYNC.

#include <cstdlib>

#include "tests/firmware/node/forwarding_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::NmtCommand;

constexpr int kSequences = 200;  // in every run; others with VOLCOMP_SEQUENCES=5000
constexpr int kCycles = 600;
// A drive that follows again sooner may take what was under way (promise 3).
constexpr int kStaysSo = 20;

int sequences() {
  const char* const wanted = std::getenv("VOLCOMP_SEQUENCES");
  return wanted == nullptr ? kSequences : std::atoi(wanted);
}

class Disorder {
 public:
  explicit Disorder(std::uint64_t seed) : bus_(seed) {
    bus_.slew = chance(0.5) ? 700 : 20'000;
    bus_.soft_rate = chance(0.5) ? 20 : 700;
    bus_.counts_sync = chance(0.5);
    keeps_target_ = chance(0.3);
    rate_ = bus_.random().in(0.002, 0.05);
  }

  void run() {
    bus_.bring_up();
    if (chance(0.7)) {
      bus_.faults.lost = bus_.random().in(0.0, 0.15);
      bus_.faults.doubled = bus_.random().in(0.0, 0.1);
      bus_.faults.late = bus_.random().in(0.0, 0.1);
    }
    for (int i = 0; i < kCycles && !testing::Test::HasFatalFailure(); ++i) {
      event();
      if (enabled_) move();
      bus_.cycle();
      forwarded_ += bus_.frames();
      for (const FollowingDrive& d : bus_.drive)
        corrected_ += d.taken && d.taken->offset() != 0 ? 1 : 0;
    }
  }
  // So that a campaign in which nothing moves is seen.
  [[nodiscard]] int forwarded() const { return forwarded_; }
  [[nodiscard]] int corrected() const { return corrected_; }

 private:
  bool chance(double p) { return bus_.random().chance(p); }
  int some(int least, int most) { return static_cast<int>(bus_.random().integer(least, most)); }

  void move() {
    speed_ = std::clamp(speed_ + some(-40'000, 40'000), -400'000, 400'000);
    bus_.move(speed_);
  }

  void event() {
    --state_for_;
    if (state_for_ <= 0 && chance(enabled_ ? 0.01 : 0.2)) change_state();
    count_down(stalled_for_, [this] { bus_.stall(false); });
    count_down(silent_for_, [this] { bus_.controller_speaks = true; });
    count_down(full_for_, [this] { bus_.bench.port_full = false; });
    count_down(no_sync_for_, [this] { bus_.sync_speaks = true; });
    count_down(unmapped_for_, [this] { map(); });
    const bool answers = stalled_for_ <= 0 && full_for_ <= 0;
    if (answers && unmapped_for_ <= 0 && chance(rate_)) happen();
  }

  void happen() {
    switch (some(0, 11)) {
      case 0:
        stalled_for_ = some(1, 40);
        return bus_.stall(true);
      case 1:
        return bus_.restart_node();
      case 2:
        silent_for_ = some(1, 30);
        bus_.controller_speaks = false;
        return;
      case 3:
        full_for_ = some(1, 10);
        bus_.bench.port_full = true;
        return;
      case 4:
        return bus_.foreign_sync();
      case 5:
        no_sync_for_ = some(1, 10);
        bus_.sync_speaks = false;
        return;
      case 6:
        bus_.bench.node->bus_state(hal::CanBusState::off);
        return bus_.bench.node->bus_state(hal::CanBusState::active);
      case 7:
        return bus_.bench.node->frames_lost(static_cast<std::uint32_t>(some(0, 3)));
      case 8:
        for (FollowingDrive& d : bus_.drive)
          d.referenced = chance(0.5);
        return;
      case 9:
        bus_.bench.nmt(NmtCommand::enter_pre_operational);
        if (chance(0.8)) bus_.start();
        return;
      case 10:
        static_cast<void>(
            bus_.bench.command(chance(0.5) ? TableCommand::deactivate : TableCommand::activate));
        return;
      default:
        return boot_drives();
    }
  }

  // Enabled, disabled, homing. A controller that keeps its target over a disable gets a step, which
  // is its own.
  void change_state() {
    state_for_ = kStaysSo;
    speed_ = 0;
    if (enabled_ && chance(0.2)) {
      homes_ = !homes_;
      return bus_.home(homes_);
    }
    if (homes_) bus_.home(homes_ = false);
    enabled_ = !enabled_;
    const auto kept = bus_.drive;
    bus_.enable(enabled_);
    for (std::size_t a = 0; keeps_target_ && a < kept.size(); ++a)
      bus_.drive[a].target = kept[a].target;
  }

  // They lose mapping and state, and the controller maps them again later.
  void boot_drives() {
    bus_.enable(enabled_ = false);
    state_for_ = kStaysSo;
    unmapped_for_ = some(5, 30);
    for (std::size_t a = 0; a < ForwardingBench::kDrives; ++a)
      bus_.boot(a);
  }
  void map() {
    bus_.mapped = {true, true, true};
    bus_.confirm_mapping();
  }

  template <class Act>
  void count_down(int& cycles, const Act& act) {
    if (cycles > 0 && --cycles == 0) act();
  }

  ForwardingBench bus_;
  double rate_ = 0.0;  // of events, per cycle
  std::int32_t speed_ = 0;
  int state_for_ = 0, stalled_for_ = 0, silent_for_ = 0, full_for_ = 0, no_sync_for_ = 0;
  int unmapped_for_ = 0, forwarded_ = 0, corrected_ = 0;
  bool enabled_ = false;
  bool homes_ = false;
  bool keeps_target_ = false;
};

TEST(NodeForwardingInDisorder, KeepsItsPromises) {
  std::int64_t forwarded = 0;
  std::int64_t corrected = 0;
  for (int i = 0; i < sequences(); ++i) {
    Disorder disorder(static_cast<std::uint64_t>(1000 + i));
    disorder.run();
    ASSERT_FALSE(HasFatalFailure()) << "sequence " << i;
    forwarded += disorder.forwarded();
    corrected += disorder.corrected();
  }
  EXPECT_GT(forwarded, sequences() * 300) << "or nothing was tried";
  EXPECT_GT(corrected, sequences() * 100);
}

}  // namespace
}  // namespace volcomp::node
