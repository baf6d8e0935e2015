#pragma once
// Looks for the most expensive tick of a compensator: all axes at once turn round, enter another
// segment, are limited, are lost, come back, leave their tables, while tables are exchanged, ramped
// in and damaged. By chance and by plan; the same in every run and on every machine.

#include <array>
#include <cstdint>
#include <cstring>

#include "comp/core/units.hpp"
#include "comp/tick/compensator.hpp"
#include "tests/target/stop.hpp"
#include "tests/target/ticks/adverse_settings.hpp"
#include "tests/target/ticks/tick_digest.hpp"
#include "tests/target/ticks/worst_cost.hpp"

namespace volcomp::target {

// `Meter`: start() and stop(start) around a tick, in instructions.
template <class Unit, class Meter>
class Adversary {
 public:
  // `tables`: two sets for the machine of the unit; they and the unit stay.
  Adversary(Unit& unit, const std::array<const MachineTables*, 2>& tables, Meter& meter)
      : unit_(unit), tables_(tables), meter_(meter), axes_(unit.machine().chain.axes) {
    sense_.fill(1);
    find_rooms(false);
    for (std::size_t a = 0; a < axes_; ++a)
      position_[a] = (room_[a].low + room_[a].high) / 2;
    find_a_setting();
  }

  SearchDigest search(Accelerations accelerations) {
    outputs_ = {};
    counts_ = {};
    settings_.limit(accelerations);
    climb(300);
    operate(25, 400);
    suffer(20, 500);
    try_pairs(accelerations == Accelerations::none ? 0 : 1);
    return {outputs_.value(), counts_.value()};
  }

  [[nodiscard]] const WorstCost& cost() const { return cost_; }
  // Every status bit that came.
  [[nodiscard]] std::uint32_t seen() const { return seen_; }

 private:
  static constexpr std::size_t kAxes = Unit::kAxes;
  using Adverse = AdverseSettings<kAxes>;
  static void require(const Status& status) {
    if (!status.ok()) stop(sentence(status.reason));
  }
  void configure() { require(unit_.configure(settings_.get())); }

  // Ordinary operation, every axis within its table. With limits that act or that never do.
  void operate(std::uint32_t epochs, std::uint32_t ticks) {
    for (std::uint32_t e = 0; e < epochs; ++e) {
      begin_epoch(false);
      for (std::uint32_t n = 0; n < ticks; ++n) {
        if (n == ticks / 2) exchange();
        step_in_order(unit_.pending() || draw_.once_in(6));
      }
    }
  }

  // Every axis on its way to a limit it has never reached, by steps that are limited, too: from a
  // new start, so that each tick sees the largest offset so far.
  void climb(std::uint32_t ticks) {
    constexpr std::array<std::int32_t, 3> kLimits{300, 2'000, 6'000};
    constexpr std::array<std::int32_t, 3> kRates{1, 10, 100};
    for (const std::int32_t limit : kLimits) {
      for (const std::int32_t rate : kRates) {
        settings_.slow(limit, rate);
        configure();
        restart();
        for (std::uint32_t n = 0; n < ticks; ++n)
          step_in_order(draw_.once_in(2));
      }
    }
  }

  // Whatever can happen, by chance.
  void suffer(std::uint32_t epochs, std::uint32_t ticks) {
    for (std::uint32_t e = 0; e < epochs; ++e) {
      begin_epoch(true);
      const std::uint32_t rarity = 3 + draw_.below(60);
      for (std::uint32_t n = 0; n < ticks; ++n) {
        disturb();
        move(false);
        sample_with_faults(rarity);
        measure(false);
      }
    }
  }

  // Every pair of faults, first one, then the other, of all axes at once; with every second plan.
  void try_pairs(std::uint32_t first_plan) {
    for (std::uint32_t plan = first_plan; plan < Adverse::kPlans; plan += 2) {
      settings_.plan(plan, room_);
      configure();
      if (!unit_.active()) restart();
      for (std::uint32_t first = 0; first < kFaults; ++first) {
        for (std::uint32_t second = 0; second < kFaults; ++second)
          try_pair(static_cast<Fault>(first), static_cast<Fault>(second), plan);
      }
    }
  }

  void try_pair(Fault first, Fault second, std::uint32_t plan) {
    require(unit_.start_from({}));
    // One in two arrives from good samples.
    sample_all(draw_.once_in(2) ? Fault::none : first);
    measure(false);
    sample_all(first);
    measure(false);
    const bool early =
        first == Fault::none || first == Fault::lost || first == Fault::beyond_end_not_homed;
    if (early && plan % kExchanging <= 1) exchange();
    if (draw_.once_in(2)) configure();  // every axis takes its limits anew
    sample_all(second);
    measure(false);
    sample_all(draw_.once_in(2) ? Fault::none : second);
    measure(false);
  }
  static constexpr std::uint32_t kExchanging = 36;  // two plans of so many exchange tables, too

  // --- what the background does

  void restart() {
    unit_.restart(unit_.machine());
    out_ = {};
    exchange();
  }

  void exchange() {
    const MachineTables& next = *tables_[exchanges_++ % tables_.size()];
    const auto& tool = next.machine.tool_point;
    require(unit_.stage(next, Vec3(tool[0], tool[1], tool[2]), 0));
    require(unit_.activate());
  }

  // Where the settings lie in the compensator: a bit of them is damaged later.
  void find_a_setting() {
    constexpr std::int32_t kMark = 3'141'593;
    settings_.mark(kMark);
    configure();
    auto* const bytes = reinterpret_cast<unsigned char*>(&unit_);
    for (std::size_t at = 0; at + sizeof kMark <= sizeof unit_ && setting_ == nullptr; at += 4) {
      if (std::memcmp(bytes + at, &kMark, sizeof kMark) == 0) setting_ = bytes + at;
    }
    if (setting_ == nullptr) stop("The settings are nowhere in the compensator.");
  }

  // A bit flips and flips back; the scrub sees it in between: corrections off, damage reported.
  void damage() {
    if (unit_.pending()) return;
    *setting_ ^= 4U;
    const bool seen = !unit_.scrub(Unit::kScrubBytes).ok();
    *setting_ ^= 4U;
    if (!seen) stop("A damaged setting was not seen.");
  }

  void disturb() {
    if (draw_.once_in(700)) exchange();
    if (draw_.once_in(900)) unit_.deactivate();
    if (draw_.once_in(1'500)) damage();
    if (!unit_.active() && !unit_.pending() && draw_.once_in(12)) exchange();
    if (draw_.once_in(200)) {  // offsets may lie beyond the new limits
      settings_.draw(draw_, room_, true);
      configure();
    }
    if (draw_.once_in(300)) unit_.begin_at_zero(draw_.below(static_cast<std::uint32_t>(axes_)));
    if (draw_.once_in(300)) require(unit_.start_from(out_.offset));
  }

  // --- positions

  [[nodiscard]] bool rotary(std::size_t axis) const {
    return unit_.machine().chain.kind[axis] == JointKind::rotary;
  }

  void find_rooms(bool whole) {
    for (std::size_t a = 0; a < axes_; ++a) {
      const AxisTable& table = tables_[0]->axis[a];
      AxisRoom& room = room_[a];
      room.pitch = table.pitch;
      room.unit = rotary(a) ? static_cast<std::int64_t>(kUnitsPerRad / 1000.0) : 1'000'000;
      room.low = table.q0 + 2 * room.unit;
      room.high = table.last() - 2 * room.unit;
      if (rotary(a) && !whole) {
        // Tilts of ±0.5 rad keep the authority of the correcting axes.
        room.low = -500 * room.unit;
        room.high = 500 * room.unit;
      }
    }
  }

  void begin_epoch(bool faults) {
    find_rooms(faults && draw_.once_in(2));
    for (std::size_t a = 0; a < axes_; ++a) {
      const AxisRoom& room = room_[a];
      position_[a] = room.low + (room.high - room.low) / 64 * draw_.below(64);
    }
    settings_.draw(draw_, room_, faults);
    configure();
    if (!unit_.active() || draw_.once_in(8)) {
      restart();
    } else {
      require(unit_.start_from({}));
      out_ = {};
    }
  }

  // Up to 2 mm or mrad further, or to another segment. `at_once`: all axes turn and jump together.
  void move(bool at_once) {
    const bool together = at_once || draw_.once_in(3);
    const bool turn = at_once || draw_.once_in(3);
    const bool jump = at_once || draw_.once_in(5);
    for (std::size_t a = 0; a < axes_; ++a) {
      if (together ? turn : draw_.once_in(3)) sense_[a] = -sense_[a];
      const AxisRoom& room = room_[a];
      std::int64_t step = room.unit / 10 + room.unit / 1'000 * draw_.below(1'901);
      if (jump) step = room.pitch;
      if (!at_once && draw_.once_in(9)) step = 0;
      position_[a] += sense_[a] * step;
      if (position_[a] > room.high) {
        position_[a] = room.high;
        sense_[a] = -1;
      }
      if (position_[a] < room.low) {
        position_[a] = room.low;
        sense_[a] = 1;
      }
    }
  }

  // A tick of ordinary operation.
  void step_in_order(bool at_once) {
    move(at_once);
    for (std::size_t a = 0; a < axes_; ++a)
      in_.axis[a] = {position_[a], true, true};
    measure(true);
  }

  void sample_with_faults(std::uint32_t rarity) {
    const bool clean = draw_.once_in(3);
    const bool all = !clean && draw_.once_in(4);
    const auto common = static_cast<Fault>(1 + draw_.below(kFaults - 1));
    for (std::size_t a = 0; a < axes_; ++a) {
      auto fault = all ? common : Fault::none;
      if (!clean && !all && draw_.once_in(rarity))
        fault = static_cast<Fault>(1 + draw_.below(kFaults - 1));
      in_.axis[a] = faulty({position_[a], true, true}, fault, room_[a]);
    }
  }

  void sample_all(Fault fault) {
    for (std::size_t a = 0; a < axes_; ++a) {
      const AxisRoom& room = room_[a];
      const std::int64_t middle = (room.low + room.high) / 2 + 100 * room.unit;
      in_.axis[a] = faulty({middle, true, true}, fault, room);
    }
  }

  // `ordinary`: a tick that may be an everyday one.
  void measure(bool ordinary) {
    const bool exchanged = unit_.pending();
    const Seen before = Seen::of(out_, settings_.get(), axes_);
    const auto start = meter_.start();
    unit_.tick(in_, out_);
    const std::uint32_t instructions = meter_.stop(start);
    const Seen now = Seen::of(out_, settings_.get(), axes_);
    cost_.add(ordinary ? kind_of(before, now, exchanged) : TickKind::anything, instructions);
    seen_ |= now.any;
    add_outputs(outputs_, unit_, out_, axes_);
    if (++ticks_ % 64 == 0) add_counts(counts_, unit_, axes_);
  }

  Unit& unit_;
  std::array<const MachineTables*, 2> tables_;
  Meter& meter_;
  std::size_t axes_;
  Adverse settings_{axes_};
  typename Unit::Input in_{};
  typename Unit::Output out_{};
  std::array<AxisRoom, kAxes> room_{};
  std::array<std::int64_t, kAxes> position_{};
  std::array<int, kAxes> sense_{};
  unsigned char* setting_ = nullptr;
  std::uint32_t exchanges_ = 0;
  std::uint32_t seen_ = 0;
  std::uint32_t ticks_ = 0;
  Draw draw_;
  Digest outputs_;
  Digest counts_;
  WorstCost cost_;
};

}  // namespace volcomp::target
