#pragma once
// What the bench of the host calls, one call at a time: our ticks and what they are compared with.
// fetch() takes the positions of a call, call() is what is measured.

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "comp/tick/instances.hpp"
#include "tests/bench/chains.hpp"
#include "tests/bench/rivals.hpp"

namespace volcomp::bench {

// How the positions go from one call to the next: a walk of 0.1 to 2 mm (or mrad), or anywhere in
// the tables.
enum class Path : std::uint8_t { smooth, jumping };

inline Walk make_path(const MachineDescription& machine, Path path) {
  const Walk smooth = make_walk(machine);
  if (path == Path::smooth) return smooth;
  std::mt19937_64 engine(20200886);
  Walk jumping(kWalk);
  for (auto& place : jumping)
    place = smooth[engine() % kWalk];
  // Each axis by itself, so that few places come twice.
  for (std::size_t a = 0; a < jumping.front().size(); ++a) {
    for (auto& place : jumping)
      place[a] = smooth[engine() % kWalk][a];
  }
  return jumping;
}

// The value reaches memory, and nothing is known of memory afterwards.
template <class Value>
void keep(Value& value) {
  asm volatile("" : : "g"(&value) : "memory");  // NOLINT(hicpp-no-assembler)
}

// The tick of one machine with all limits on, none of which is met.
template <class Machine>
class TickWork {
 public:
  TickWork(const MachineDescription& machine, Path path, const Machine& made = {})
      : unit_(std::make_unique<Compensator<Machine>>(made)) {
    const Walk walk = make_path(machine, path);
    in_.resize(kWalk);
    for (std::size_t i = 0; i < kWalk; ++i) {
      for (std::size_t a = 0; a < Compensator<Machine>::kAxes; ++a)
        in_[i].axis[a] = {walk[i][a], true, true};
    }
    typename Compensator<Machine>::Settings settings;
    for (AxisLimits& limits : settings.axis) {
      limits.rate = 1'000'000;
      limits.max_step = 1'000'000'000'000;
    }
    settings.ramp_ticks = 1;
    const auto tables = make_tables(machine);
    const Vec3 tool_point = Eigen::Map<const Vec3>(machine.tool_point.data());
    const bool ready = unit_->configure(settings).ok() &&
                       unit_->stage(*tables, tool_point, 0).ok() && unit_->activate().ok();
    if (!ready) std::abort();
  }

  void fetch(std::size_t i) { now_ = in_[i % kWalk]; }
  void call() {
    unit_->tick(now_, out_);
    keep(out_);
  }

 private:
  std::unique_ptr<Compensator<Machine>> unit_;
  std::vector<typename Compensator<Machine>::Input> in_;
  typename Compensator<Machine>::Input now_{};
  typename Compensator<Machine>::Output out_;
};

// Places of three axes, mm.
template <class Number>
std::vector<std::array<Number, 3>> places(Path path) {
  std::vector<std::array<Number, 3>> out;
  for (const auto& q : make_path(kGeneric, path)) {
    out.push_back({});
    for (std::size_t a = 0; a < 3; ++a)
      out.back()[a] = static_cast<Number>(static_cast<double>(q[a]) / kNmPerMm);
  }
  return out;
}

template <class Table>
class LookupWork {
 public:
  explicit LookupWork(Path path) : tables_(channel_tables<Table>()), at_(places<float>(path)) {}
  void fetch(std::size_t i) { now_ = at_[i % kWalk]; }
  void call() {
    value_ = eighteen_lookups(*tables_, now_);
    keep(value_);
  }

 private:
  std::unique_ptr<TablesOf<Table>> tables_;
  std::vector<std::array<float, 3>> at_;
  std::array<float, 3> now_{};
  std::array<float, 18> value_{};
};

class ScrewWork {
 public:
  explicit ScrewWork(Path path) : at_(places<double>(path)) {
    const auto tables = make_tables(kGeneric);
    for (std::size_t a = 0; a < 3; ++a)
      axis_.emplace_back(entries_of(tables->axis[a]));
  }
  void fetch(std::size_t i) { now_ = at_[i % kWalk]; }
  void call() {
    for (std::size_t a = 0; a < 3; ++a)
      value_[a] = axis_[a].step(now_[a]);
    keep(value_);
  }

 private:
  static std::vector<ScrewCompensation::Entry> entries_of(const AxisTable& table) {
    std::vector<ScrewCompensation::Entry> entries(table.knots);
    for (std::size_t k = 0; k < table.knots; ++k) {
      entries[k].position =
          static_cast<double>(table.q0 + static_cast<std::int64_t>(k) * table.pitch) / kNmPerMm;
      for (std::size_t way = 0; way < 2; ++way)
        entries[k].trim[way] = table.value[way][k][0];
    }
    for (std::size_t k = 0; k + 1 < table.knots; ++k) {
      const double pitch = entries[k + 1].position - entries[k].position;
      for (std::size_t way = 0; way < 2; ++way)
        entries[k].slope[way] = (entries[k + 1].trim[way] - entries[k].trim[way]) / pitch;
    }
    return entries;
  }

  std::vector<ScrewCompensation> axis_;
  std::vector<std::array<double, 3>> at_;
  std::array<double, 3> now_{};
  std::array<double, 3> value_{};
};

// A function of the first axis.
template <class Number, std::array<Number, 3> (*kFunction)(Number)>
class ChainWork {
 public:
  explicit ChainWork(Path path) : at_(places<Number>(path)) {}
  void fetch(std::size_t i) { now_ = at_[i % kWalk]; }
  void call() {
    value_ = kFunction(now_[0]);
    keep(value_);
  }

 private:
  std::vector<std::array<Number, 3>> at_;
  std::array<Number, 3> now_{};
  std::array<Number, 3> value_{};
};

// What calling costs, with three numbers fetched.
class NoWork {
 public:
  void fetch(std::size_t i) { now_ = at_[i % kWalk]; }
  void call() { keep(now_); }

 private:
  std::vector<std::array<double, 3>> at_ = std::vector<std::array<double, 3>>(kWalk);
  std::array<double, 3> now_{};
};

}  // namespace volcomp::bench
