#include "host_sim/host/measure/verification.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/diagonals.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/intervals/positioning_interval.hpp"
#include "host_sim/host/measure/intervals/run_figures.hpp"
#include "host_sim/host/measure/intervals/volume_interval.hpp"

namespace volcomp::host {
namespace {

using Runs = std::vector<std::vector<double>>;  // µm, by run and target

constexpr std::size_t kIsoRuns = 5;  // ISO 230-2 asks for so many runs and targets, as remembered

// All that is known of one measured diagonal, µm.
struct Evaluated {
  Repetition repetition;
  RunFigures figures;
  RunIntervals intervals;
};

Runs runs_of(const DiagonalRuns& d, bool up) {
  Runs runs;
  for (const DiagonalRun& run : d.runs) {
    if (run.up != up) continue;
    runs.emplace_back();
    for (const double mm : run.deviation_mm)
      runs.back().push_back(kUmPerMm * mm);
  }
  return runs;
}

Evaluated evaluate(const DiagonalRuns& d, const VerificationInput& input) {
  const Runs up = runs_of(d, true);
  const Runs down = runs_of(d, false);
  Evaluated e;
  require(run_figures(up, down, e.figures), d.name);
  e.repetition = {d.length_mm(), e.figures.runs, e.figures.both_directions};
  std::vector<double> positions;
  for (const DiagonalTarget& t : d.targets)
    positions.push_back(t.distance_mm);
  e.intervals = run_intervals(positions, up, down, stated_errors(input.uncertainty, d.length_mm()),
                              input.seed, input.draws);
  return e;
}

Change change_between(const Figure& before, const Figure& after) {
  if (before.interval && after.interval) {
    if (after.interval->high < before.interval->low) return Change::better;
    return after.interval->low > before.interval->high ? Change::worse : Change::not_significant;
  }
  const double difference = before.um - after.um;
  // Independent: what device and surroundings have in common before and after would only help.
  const double U =
      std::hypot(before.instrument_um.value_or(0.0), after.instrument_um.value_or(0.0));
  if (difference > U) return Change::better;
  return -difference > U ? Change::worse : Change::not_significant;
}

FigureComparison compared(std::string where, std::string name, const Figure& before,
                          const Figure& after) {
  return {std::move(where), std::move(name), before, after, change_between(before, after), false};
}

// Of places whose uncertainty is stated.
FigureInterval interval_of_volume(const VolumeFile& file, const VerificationInput& input,
                                  std::size_t draws) {
  VolumeErrors errors;
  for (const VolumePoint& p : aligned(file.points)) {
    for (const double mm : p.error_mm)
      errors.error.push_back(kUmPerMm * mm);
  }
  errors.u = 0.5 * *input.uncertainty.volume_um;
  return draws > 0 ? volume_interval(errors, input.seed, draws) : widest_volume_interval(errors);
}

class Verification {
 public:
  explicit Verification(const VerificationInput& input) : input_(input) {}

  VerificationResult run() {
    require_complete(input_.uncertainty);
    require_same_points(input_.before, input_.after);
    evaluate_all();
    result_.least_runs = SIZE_MAX;
    for (std::size_t i = 0; i < input_.before.diagonals.size(); ++i)
      take_diagonal(input_.before.diagonals[i], before_[i], after_[i]);
    take_group("body diagonals", true);
    take_group("face diagonals", false);
    if (input_.volume_before) take_volume(*input_.volume_before, *input_.volume_after);
    remark_on_statistics();
    result_.left_out = left_out(input_.uncertainty, result_.least_runs > 1);
    result_.stated = stated_values(input_.uncertainty, any_interval("E"), any_interval("max"));
    judge(input_, result_);
    return std::move(result_);
  }

 private:
  const DiagonalRuns& counterpart(const std::string& name) const {
    return *std::find_if(input_.after.diagonals.begin(), input_.after.diagonals.end(),
                         [&](const DiagonalRuns& d) { return d.name == name; });
  }

  // Draws take their time; every processor does some diagonals.
  void evaluate_all() {
    const std::size_t count = input_.before.diagonals.size();
    before_.resize(count);
    after_.resize(count);
    in_parallel(2 * count, processors(), [&](std::size_t job) {
      const DiagonalRuns& d = input_.before.diagonals[job / 2];
      if (job % 2 == 0) {
        before_[job / 2] = evaluate(d, input_);
      } else {
        after_[job / 2] = evaluate(counterpart(d.name), input_);
      }
    });
  }

  Figure figure(const Evaluated& e, double um, FigureKind kind,
                FigureInterval PositioningIntervals::*interval) {
    const std::vector<Contribution> list = contributions(input_.uncertainty, e.repetition, kind);
    const std::optional<double> U = expanded_um(list);
    if (kind == FigureKind::systematic &&
        U.value_or(-1.0) > expanded_um(result_.largest_contributions).value_or(-1.0))
      result_.largest_contributions = list;
    Figure f{um, {}, U};
    if (e.intervals.of) f.interval = *e.intervals.of.*interval;
    return f;
  }

  void take_diagonal(const DiagonalRuns& diagonal, const Evaluated& b, const Evaluated& a) {
    using Of = PositioningIntervals;
    using Iso = Iso230Figures;
    const auto add = [&](const char* name, FigureKind kind, double um_before, double um_after,
                         FigureInterval Of::*interval) {
      result_.figures.push_back(compared(diagonal.name, name, figure(b, um_before, kind, interval),
                                         figure(a, um_after, kind, interval)));
    };
    const auto add_iso = [&](const char* name, FigureKind kind, double Iso::*um,
                             FigureInterval Of::*interval) {
      add(name, kind, b.figures.iso.*um, a.figures.iso.*um, interval);
    };
    const bool both = b.repetition.both_directions;
    const bool repeated = b.repetition.runs > 1;
    add("largest", FigureKind::largest, b.figures.largest, a.figures.largest, &Of::largest);
    add_iso("E", FigureKind::systematic, &Iso::E, &Of::E);
    if (both) add_iso("B", FigureKind::reversal, &Iso::B, &Of::B);
    if (both) add_iso("M", FigureKind::largest, &Iso::M, &Of::M);
    if (repeated) add_iso("A", FigureKind::systematic, &Iso::A, &Of::A);
    if (repeated) add_iso("R", FigureKind::repeatability, &Iso::R, &Of::R);
    result_.least_runs = std::min({result_.least_runs, b.repetition.runs, a.repetition.runs});
    least_targets_ = std::min(least_targets_, diagonal.targets.size());
    remark_on_runs(diagonal.name, b, a);
    add_curves(diagonal, b.figures.curve, a.figures.curve);
  }

  void remark_on_runs(const std::string& name, const Evaluated& b, const Evaluated& a) {
    if (!b.repetition.both_directions) {
      result_.remarks.push_back(fmt::format(
          "{}: measured in one direction only, the reversal B is unknown and there is no interval",
          name));
      return;
    }
    const auto remark = [&](const Evaluated& e, const char* when) {
      const RunIntervals& i = e.intervals;
      if (!i.of) without_[sentence(i.refusal.reason)].push_back(name + " " + when);
      if (i.of && i.of->runs_differ) runs_differ_.push_back(name + " " + when);
    };
    remark(b, "before");
    remark(a, "after");
  }

  void remark_on_statistics() {
    for (const auto& [why, names] : without_)
      result_.remarks.push_back(fmt::format("{}: no interval. {}", fmt::join(names, ", "), why));
    if (!runs_differ_.empty())
      result_.remarks.push_back(
          fmt::format("{}: runs differ: interval may cover less than 95 %, of A and R",
                      fmt::join(runs_differ_, ", ")));
    if (result_.least_runs == 2) {
      result_.remarks.emplace_back("n = 2: no ISO 230-2 test");
    } else if (result_.least_runs < kIsoRuns || least_targets_ < kIsoRuns) {
      result_.remarks.push_back(fmt::format(
          "not a test after ISO 230-2, with its {} runs and targets or more: {} run{}, "
          "{} targets",
          kIsoRuns, result_.least_runs, result_.least_runs == 1 ? "" : "s", least_targets_));
    }
  }

  [[nodiscard]] bool any_interval(const std::string& name) const {
    return std::any_of(result_.figures.begin(), result_.figures.end(),
                       [&](const FigureComparison& f) {
                         return f.name == name && (f.before.interval || f.after.interval);
                       });
  }

  void add_curves(const DiagonalRuns& d, const std::vector<double>& before_um,
                  const std::vector<double>& after_um) {
    DiagonalCurves c{d.name, {}, before_um, after_um, {}};
    for (const DiagonalTarget& t : d.targets)
      c.distance_mm.push_back(t.distance_mm);
    if (input_.tables)
      c.predicted = input_.tables->prediction(c.name, c.distance_mm, before_um, after_um);
    result_.curves.push_back(std::move(c));
  }

  // The largest of all of a kind: each end is the largest of theirs, since the true largest is no
  // less than any, and no more than the most that any may be; no interval where one has none.
  std::optional<Figure> figure_of_group(const std::string& name, bool body,
                                        Figure FigureComparison::*when) const {
    std::optional<Figure> group;
    FigureInterval largest;
    bool all = true;
    for (const FigureComparison& f : result_.figures) {
      if (f.name != name || is_body_diagonal(f.where) != body) continue;
      const Figure& one = f.*when;
      if (!group || one.um > group->um) group = one;
      all = all && one.interval.has_value();
      if (!one.interval) continue;
      largest.corrected = std::max(largest.corrected, one.interval->corrected);
      largest.low = std::max(largest.low, one.interval->low);
      largest.high = std::max(largest.high, one.interval->high);
      largest.upper95 = std::max(largest.upper95, one.interval->upper95);
    }
    largest.estimate = group ? group->um : 0.0;
    if (group && all) group->interval = largest;
    if (group && !all) group->interval.reset();
    return group;
  }

  // The largest E and B of the diagonals of one kind.
  void take_group(const char* where, bool body) {
    for (const char* name : {"E", "B"}) {
      const std::optional<Figure> before = figure_of_group(name, body, &FigureComparison::before);
      const std::optional<Figure> after = figure_of_group(name, body, &FigureComparison::after);
      if (!before) continue;
      FigureComparison group = compared(where, fmt::format("{}_d", name), *before, *after);
      group.decides = name[0] == 'E';
      result_.figures.push_back(group);
    }
  }

  void take_volume(const VolumeFile& before, const VolumeFile& after) {
    require_same_places(before, after);
    const VolumeFigures b = aligned_volume_figures(before.points);
    const VolumeFigures a = aligned_volume_figures(after.points);
    const std::optional<double> U = input_.uncertainty.volume_um;
    std::array<Figure, 2> most{{{b.max_um, {}, U}, {a.max_um, {}, U}}};
    if (U.value_or(0.0) > 0.0) {
      const std::size_t draws = affordable_draws(before.points.size(), input_.draws);
      in_parallel(2, processors(), [&](std::size_t i) {
        most.at(i).interval = interval_of_volume(i == 0 ? before : after, input_, draws);
      });
      remark_on_draws(draws, before.points.size());
    } else if (!U) {
      result_.remarks.emplace_back("volume: uncertainty not stated (volume_um), no interval");
    }
    FigureComparison largest = compared("volume", "max", most[0], most[1]);
    largest.decides = true;
    result_.figures.push_back(largest);
    result_.figures.push_back(compared("volume", "rms", {b.rms_um, {}, U}, {a.rms_um, {}, U}));
  }

  void remark_on_draws(std::size_t draws, std::size_t places) {
    if (draws == 0)
      result_.remarks.push_back(fmt::format(
          "volume: {} places are too many for draws; the interval is the widest that noise alone "
          "can make it, the corrected figure that of the data",
          places));
    else if (draws < input_.draws)
      result_.remarks.push_back(fmt::format("volume: {} draws for {} places", draws, places));
  }

  const VerificationInput& input_;
  VerificationResult result_;
  std::vector<Evaluated> before_, after_;  // in the order of input_.before
  std::size_t least_targets_ = SIZE_MAX;
  std::map<std::string, std::vector<std::string>> without_;  // sentence: which have no interval
  std::vector<std::string> runs_differ_;
};

}  // namespace

double FigureComparison::reduction_percent() const {
  return improvement_percent(before.um, after.um);
}

VerificationResult verify(const VerificationInput& input) { return Verification(input).run(); }

}  // namespace volcomp::host
