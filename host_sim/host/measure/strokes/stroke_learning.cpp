#include "host_sim/host/measure/strokes/stroke_learning.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "comp/strokes/helix_instances.hpp"
#include "comp/strokes/learning_guard.hpp"
#include "host_sim/host/bus/watched_strokes.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr std::array<Direction, 2> kDirections{Direction::forward, Direction::backward};
constexpr long kMostLost = 1000;  // cycles; more of them say no more

class SizeOf {
 public:
  void add(double value) {
    peak_ = std::max(peak_, std::abs(value));
    squares_ += value * value;
    ++n_;
  }
  [[nodiscard]] SignalSize size() const {
    return {peak_, n_ == 0 ? 0.0 : std::sqrt(squares_ / static_cast<double>(n_))};
  }

 private:
  double peak_ = 0.0;
  double squares_ = 0.0;
  std::size_t n_ = 0;
};

// Slots by where C stands while Z is at mid face, or as the log says.
class SlotCounter {
 public:
  SlotCounter(const InternalGear& gear, const std::string& log) : gear_(gear), log_(log) {}

  std::uint16_t of(const StrokeSample& s) {
    if (s.slot) {
      if (*s.slot < gear_.teeth) return *s.slot;
      throw UserError(fmt::format("{}:{}: slot {}, but the gear has {} teeth", log_, s.line,
                                  *s.slot, gear_.teeth));
    }
    // C turns against Z along the helix (internal_gear.hpp): e_C + e_Z / p is out of step.
    const double at_mid_face = s.c.command + s.z.command * gear_.turn_per_mm;
    if (!known_) first_ = at_mid_face;
    known_ = true;
    const double pitch = 2.0 * kPi / gear_.teeth;
    const auto slot = std::lround(-(at_mid_face - first_) / pitch) % gear_.teeth;
    return static_cast<std::uint16_t>(slot < 0 ? slot + gear_.teeth : slot);
  }
  [[nodiscard]] std::string text() const {
    if (!known_) return "as the log says";
    return fmt::format("slot 0 is the first of the log, where C stands at {:.4f}° with Z at 0",
                       first_ * 180.0 / kPi);
  }

 private:
  const InternalGear& gear_;
  const std::string& log_;
  double first_ = 0.0;
  bool known_ = false;
};

// The samples within the face, where the wheel passes it from end to end: a part of a pass has
// another mean. Unknown elsewhere; `discarded` names what is left out.
std::vector<Direction> ways_through(const StrokeLog& log, double half_face_mm,
                                    std::vector<std::string>& discarded) {
  const std::vector<StrokeSample>& all = log.samples;
  std::vector<Direction> way(all.size(), Direction::unknown);
  const auto outside = [&](std::size_t i) { return std::abs(all[i].z.command) > half_face_mm; };
  for (std::size_t begin = 0; begin < all.size();) {
    if (outside(begin)) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < all.size() && !outside(end))
      ++end;
    const bool whole = begin > 0 && end < all.size() &&
                       (all[begin - 1].z.command < 0.0) != (all[end].z.command < 0.0);
    if (whole) {
      const Direction d = all[end].z.command > 0.0 ? Direction::forward : Direction::backward;
      std::fill(way.begin() + static_cast<std::ptrdiff_t>(begin),
                way.begin() + static_cast<std::ptrdiff_t>(end), d);
    } else {
      discarded.push_back(fmt::format("lines {} to {}: the face is not passed from end to end",
                                      all[begin].line, all[end - 1].line));
    }
    begin = end;
  }
  return way;
}

class Learner {
 public:
  Learner(const StrokeLog& log, const MachineFile& machine, const LearnSettings& settings)
      : log_(log), settings_(settings), slots_(grinding_of(machine).gear, log.name) {
    result_.machine = machine;
    const GrindingFile& job = *machine.grinding;
    watched_ = watched_strokes(job, kNodeSpacing_mm, log.period_s);
    watched_.along.weight = watched_.around.weight = settings.weight;
    half_face_mm_ = 0.5 * job.width_mm;
    require(monitor_->configure(watched_.monitor), machine.path);
    for (auto& learner : stroke_)
      require(learner.start(watched_.along, watched_.monitor.nodes), machine.path + ": stroke");
    require(slot_.start(watched_.around, watched_.slots), machine.path + ": teeth");
    load_tables_before();
  }

  StrokesLearned learn() {
    watch();
    if (passes() == 0) {
      throw UserError(fmt::format(
          "{}: no whole pass through the face, Z from {:g} to {:g} mm{}", log_.name, -half_face_mm_,
          half_face_mm_, result_.discarded.empty() ? "" : ": " + result_.discarded.front()));
    }
    for (std::size_t d = 0; d < kDirections.size(); ++d) {
      std::vector<NodeSums> sums(watched_.monitor.nodes);
      monitor_->totals().stroke_sums(kDirections.at(d), sums);
      result_.tables.stroke.at(d) = step(stroke_.at(d), sums, result_.step.at(d));
      result_.passes.at(d) = monitor_->totals().passes(kDirections.at(d));
    }
    std::vector<NodeSums> sums(watched_.slots);
    monitor_->totals().slot_sums(sums);
    result_.tables.slot = step(slot_, sums, result_.step[2]);
    return std::move(result_);
  }

 private:
  void load_tables_before() {
    LearnedTables& t = result_.tables;
    t.z0_mm = -half_face_mm_;
    t.pitch_mm = kNodeSpacing_mm;
    t.stroke.fill(std::vector<double>(watched_.monitor.nodes, 0.0));
    t.slot.assign(watched_.slots, 0.0);
    if (settings_.before.empty()) return;
    t = read_learned(settings_.before, t, result_.machine.id, watched_.along.most_offset,
                     settings_.before_name);
    for (std::size_t d = 0; d < kDirections.size(); ++d)
      stroke_.at(d).load([&](std::size_t j) { return t.stroke.at(d)[j]; });
    slot_.load([&](std::size_t k) { return t.slot[k]; });
  }

  [[nodiscard]] std::size_t passes() const {
    return std::size_t{monitor_->totals().passes(Direction::forward)} +
           monitor_->totals().passes(Direction::backward);
  }

  void watch() {
    result_.log = log_.name;
    result_.cycles = log_.samples.size();
    result_.period_s = log_.period_s;
    result_.has_x = log_.has_x;
    way_ = ways_through(log_, half_face_mm_, result_.discarded);
    std::vector<double> feeds;
    for (std::size_t i = 1; i < log_.samples.size(); ++i) {
      const long cycles = cycles_before(i);
      const HelixFrame f = frame(i, cycles);
      monitor_->tick(f);
      collect(log_.samples[i]);
      if (f.in_face) measure(i, cycles, feeds);
    }
    result_.x = x_.size();
    result_.z = z_.size();
    result_.c = c_.size();
    result_.out_of_step_um = flank_.size();
    result_.slot_0 = slots_.text();
    if (feeds.empty()) return;
    const auto middle = feeds.begin() + static_cast<std::ptrdiff_t>(feeds.size() / 2);
    std::nth_element(feeds.begin(), middle, feeds.end());
    result_.feed_mm_per_s = *middle;
  }

  // Since the sample before, lost ones among them; time stamps may jitter.
  [[nodiscard]] long cycles_before(std::size_t i) const {
    const double step_s = log_.samples[i].time_s - log_.samples[i - 1].time_s;
    return std::lround(std::clamp(step_s / log_.period_s, 1.0, double{kMostLost}));
  }

  HelixFrame frame(std::size_t i, long cycles) {
    const StrokeSample& s = log_.samples[i];
    sequence_ = static_cast<std::uint16_t>(sequence_ + cycles);
    HelixFrame f;
    f.x = {to_nm(s.x.command), to_nm(s.x.actual), 0, true};
    f.z = {to_nm(s.z.command), to_nm(s.z.actual), 0, true};
    f.c = {to_units(s.c.command, kUnitsPerRad), to_units(s.c.actual, kUnitsPerRad), 0, true};
    f.sequence = sequence_;
    f.stroke = way_[i];
    f.in_face = f.stroke != Direction::unknown;
    f.slot = f.in_face ? slots_.of(s) : std::uint16_t{0};
    return f;
  }

  void collect(const StrokeSample& s) {
    if (!monitor_->pass_waits()) return;
    const Status status = monitor_->collect();
    if (!status.ok())
      result_.discarded.push_back(
          fmt::format("the pass that ends at line {}: {}", s.line, describe(status)));
  }

  void measure(std::size_t i, long cycles, std::vector<double>& feeds) {
    const InternalGear& gear = result_.machine.grinding->gear;
    const StrokeSample& s = log_.samples[i];
    const double e_z = s.z.actual - s.z.command;
    const double e_c = s.c.actual - s.c.command;
    x_.add(s.x.actual - s.x.command);
    z_.add(e_z);
    c_.add(e_c);
    flank_.add(kUmPerMm * gear.normal_lever() * (e_c + e_z * gear.turn_per_mm));
    const double step_mm = s.z.command - log_.samples[i - 1].z.command;
    feeds.push_back(std::abs(step_mm) / (static_cast<double>(cycles) * log_.period_s));
  }

  [[nodiscard]] double on_flank(const LearningRules& rules, const std::vector<NodeSums>& s) const {
    const double rms = rms_of_means(rules, s);
    return std::isfinite(rms) ? kUmPerMm * watched_.monitor.flank_per_rad * rms : 0.0;
  }

  template <std::size_t N>
  std::vector<double> step(OffsetLearner<N>& learner, std::vector<NodeSums>& sums,
                           TableStep& step) const {
    const std::vector<double> before(learner.table().begin(), learner.table().end());
    step.before_um = on_flank(learner.rules(), sums);
    step.report = learner.step(step.before_um, sums).report;
    std::vector<double> table(learner.table().begin(), learner.table().end());
    for (std::size_t j = 0; j < sums.size(); ++j) {
      sums[j].sum += sums[j].n * (table[j] - before[j]);
      step.peak_rad = std::max(step.peak_rad, std::abs(table[j]));
    }
    step.after_um = on_flank(learner.rules(), sums);
    return table;
  }

  const StrokeLog& log_;
  const LearnSettings& settings_;
  SlotCounter slots_;
  WatchedStrokes watched_;
  double half_face_mm_ = 0.0;
  std::vector<Direction> way_;
  std::uint16_t sequence_ = 0;
  SizeOf x_;
  SizeOf z_;
  SizeOf c_;
  SizeOf flank_;
  StrokesLearned result_;
  std::unique_ptr<GrinderMonitor> monitor_ = std::make_unique<GrinderMonitor>();
  std::array<OffsetLearner<kStrokeNodes>, 2> stroke_{};
  OffsetLearner<kGearSlots> slot_{};
};

}  // namespace

bool StrokesLearned::good() const {
  const bool refused = std::any_of(step.begin(), step.end(), [](const TableStep& s) {
    return s.report.result == LearningResult::slope || s.report.result == LearningResult::nonfinite;
  });
  const bool changed = std::any_of(step.begin(), step.end(),
                                   [](const TableStep& s) { return s.report.updated > 0; });
  return changed && !refused;
}

StrokesLearned learn_strokes(const StrokeLog& log, const MachineFile& machine,
                             const LearnSettings& settings) {
  return Learner(log, machine, settings).learn();
}

}  // namespace volcomp::host
