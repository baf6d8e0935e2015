#pragma once
// Drives one compensator through the measured ticks; counts the instructions of each and the stack
// it takes.

#include "comp/tick/compensator.hpp"
#include "hal/mps2/instruction_counter.hpp"
#include "tests/target/stop.hpp"
#include "tests/target/ticks/motion.hpp"
#include "tests/target/ticks/tally.hpp"

namespace volcomp::target {

using hal::mps2::InstructionCounter;

template <class Unit>
class TickRun {
 public:
  static constexpr std::size_t kAxes = Unit::kAxes;

  // `tables`: two sets for the same machine; they, the compensator and the counter stay.
  TickRun(Unit& unit, const std::array<const MachineTables*, 2>& tables,
          InstructionCounter& counter)
      : unit_(unit), tables_(tables), counter_(counter) {
    const MachineDescription& machine = tables[0]->machine;
    for (std::size_t k = 0; k < machine.body_count; ++k) {
      const Joint& joint = machine.body[k].joint;
      if (!joint.moves()) continue;
      motion_[joint.nc_axis] = {tables[0]->axis[joint.nc_axis], joint.kind == JointKind::rotary};
      ++axes_;
    }
    find_limits();
  }

  // Ordinary operation; the tables are exchanged every 6250 ticks.
  void operate(std::uint32_t ticks, Tally& tally) {
    for (std::uint32_t n = 0; n < ticks; ++n) {
      if (n % 6'250 == 3'000) exchange();
      measure(move(), tally);
    }
  }

  // What should not happen: axes misbehave, corrections are switched off and on again.
  void suffer(std::uint32_t ticks, Tally& tally) {
    for (std::size_t a = 0; a < axes_; ++a)
      settings_.axis[a].max_step = motion_[a].implausible_step();
    require(unit_.configure(settings_));
    std::array<AxisTrouble, kAxes> trouble{};
    for (std::uint32_t n = 0; n < ticks; ++n) {
      if (n % 1'000 == 300) unit_.deactivate();
      if (n % 1'000 == 500) exchange();
      const Kinds kinds = move();
      for (std::size_t a = 0; a < axes_; ++a)
        trouble[a].disturb(in_.axis[a], draw_);
      measure(kinds, tally);
    }
  }

  // Bytes of stack, without what the interrupt around the tick takes: the most that was written to.
  [[nodiscard]] std::uint32_t stack_bytes() const { return stack_bytes_; }

 private:
  static constexpr std::int32_t kNoLimit = 4'194'303;

  static void require(const Status& status) {
    if (!status.ok()) stop(sentence(status.reason));
  }

  // Lets the offsets run free, then limits them to three quarters of what they reached, so that the
  // clamps will act, and waits until they are there. None of these ticks is measured.
  void find_limits() {
    constexpr int kTicks = 5'000;
    settings_.ramp_ticks = 50;
    for (AxisLimits& limits : settings_.axis) {
      limits.limit = kNoLimit;
      limits.rate = 2'000;
    }
    require(unit_.configure(settings_));
    exchange();
    for (int n = 0; n < kTicks; ++n) {
      move();
      unit_.tick(in_, out_);
    }
    for (std::size_t a = 0; a < axes_; ++a) {
      const std::int32_t largest = unit_.diagnostics().largest[a];
      if (largest > 0) settings_.axis[a].limit = largest - largest / 4;
    }
    require(unit_.configure(settings_));
    for (int n = 0; n < 1'000; ++n) {
      move();
      unit_.tick(in_, out_);
    }
  }

  void exchange() {
    const MachineTables& next = *tables_[exchanges_++ % tables_.size()];
    const auto& tool = next.machine.tool_point;
    require(unit_.stage(next, Vec3(tool[0], tool[1], tool[2]), 0));
    require(unit_.activate());
  }

  Kinds move() {
    Kinds kinds = unit_.pending() ? bit(Kind::swap) : 0U;
    for (std::size_t a = 0; a < axes_; ++a) {
      kinds |= motion_[a].step(draw_, out_.offset[a]);
      in_.axis[a] = {motion_[a].position(), true, true};
    }
    return kinds;
  }

  void measure(Kinds kinds, Tally& tally) {
    const auto status_before = out_.status;
    volatile std::uint32_t* const below = paint_below_here();
    const std::uint32_t start = InstructionCounter::ticks();
    const std::uint32_t before = InstructionCounter::ticks();
    unit_.tick(in_, out_);
    const std::uint32_t after = InstructionCounter::ticks();
    look_for_paint(below);
    kinds |= shown_by_status();
    if (out_.status != status_before) kinds |= bit(Kind::status);
    if (kinds == 0) kinds = bit(Kind::plain);
    tally.add(kinds | bit(Kind::any),
              counter_.between(before, after) - counter_.between(start, before));
  }

  [[nodiscard]] Kinds shown_by_status() const {
    unsigned seen = 0;
    for (std::size_t a = 0; a < axes_; ++a)
      seen |= out_.status[a];
    const auto when = [seen](unsigned mask, Kind kind) {
      return (seen & mask) != 0 ? bit(kind) : Kinds{0};
    };
    return when(kClamped, Kind::clamp) | when(kRateLimited, Kind::rate) |
           when(kRamping, Kind::ramp) | when(kOutOfRange, Kind::outside) |
           when(kStale, Kind::lost) | when(kNotHomed, Kind::not_homed) | when(kNoTables, Kind::off);
  }

  // The stack below the caller, not in use yet: there is no interrupt in these images.
  static constexpr std::uint32_t kPaint = 0xA5A5'5A5A;
  static constexpr std::ptrdiff_t kPainted = 256;  // words

  [[gnu::always_inline]] static volatile std::uint32_t* paint_below_here() {
    volatile std::uint32_t* here = nullptr;
    __asm volatile("mov %0, sp" : "=r"(here));
    for (std::ptrdiff_t i = 1; i <= kPainted; ++i)
      here[-i] = kPaint;
    return here;
  }
  [[gnu::always_inline]] void look_for_paint(const volatile std::uint32_t* here) {
    std::ptrdiff_t deepest = kPainted;
    while (deepest > 0 && here[-deepest] == kPaint)
      --deepest;
    const auto bytes = static_cast<std::uint32_t>(deepest) * sizeof(std::uint32_t);
    if (bytes > stack_bytes_) stack_bytes_ = bytes;
  }

  Unit& unit_;
  std::array<const MachineTables*, 2> tables_;
  InstructionCounter& counter_;
  typename Unit::Settings settings_{};
  typename Unit::Input in_{};
  typename Unit::Output out_{};
  std::array<AxisMotion, kAxes> motion_{};
  std::size_t axes_ = 0;
  std::uint32_t exchanges_ = 0;
  std::uint32_t stack_bytes_ = 0;
  Draw draw_;
};

}  // namespace volcomp::target
