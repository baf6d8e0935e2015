#include "host_sim/host/measure/verification.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/diagonals.hpp"
#include "comp/metrology/tables/iso230.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// Mean and standard deviation (n − 1) of the runs of one direction, µm, by target.
struct Direction {
  std::size_t runs = 0;
  std::vector<double> mean;
  std::vector<double> deviation;
};

Direction statistics(const DiagonalRuns& d, bool up) {
  Direction s;
  std::vector<double> squares(d.targets.size(), 0.0);
  s.mean.assign(d.targets.size(), 0.0);
  s.deviation.assign(d.targets.size(), 0.0);
  // Welford's way: no difference of large sums.
  for (const DiagonalRun& run : d.runs) {
    if (run.up != up) continue;
    ++s.runs;
    for (std::size_t t = 0; t < s.mean.size(); ++t) {
      const double value = kUmPerMm * run.deviation_mm[t];
      const double before = value - s.mean[t];
      s.mean[t] += before / static_cast<double>(s.runs);
      squares[t] += before * (value - s.mean[t]);
    }
  }
  if (s.runs < 2) return s;
  for (std::size_t t = 0; t < s.mean.size(); ++t)
    s.deviation[t] = std::sqrt(squares[t] / static_cast<double>(s.runs - 1));
  return s;
}

// All that is known of one measured diagonal.
struct Evaluated {
  Repetition repetition;
  Iso230Figures figures;         // µm
  std::vector<double> curve_um;  // mean of both directions from the first target on
  double largest_um = 0.0;
};

double pooled(const Direction& up, const Direction& down) {
  double squares = 0.0;
  for (const Direction* d : {&up, &down}) {
    for (const double s : d->deviation)
      squares += s * s;
  }
  return std::sqrt(squares / static_cast<double>(2 * up.deviation.size()));
}

Evaluated evaluate(const DiagonalRuns& d) {
  Direction up = statistics(d, true);
  Direction down = statistics(d, false);
  const bool both = up.runs > 0 && down.runs > 0;
  if (up.runs == 0) up = down;
  if (down.runs == 0) down = up;
  Evaluated e;
  e.repetition = {d.length_mm(), std::min(up.runs, down.runs), both, pooled(up, down)};
  require(iso230_figures({up.mean, up.deviation}, {down.mean, down.deviation}, e.figures), d.name);
  const double first = 0.5 * (up.mean[0] + down.mean[0]);
  for (std::size_t t = 0; t < d.targets.size(); ++t)
    e.curve_um.push_back(0.5 * (up.mean[t] + down.mean[t]) - first);
  e.largest_um = diagonal_figures({e.curve_um.data(), e.curve_um.size()}).max_abs;
  return e;
}

Change change_between(const Figure& before, const Figure& after) {
  const double difference = before.um - after.um;
  // Independent: what device and surroundings have in common before and after would only help.
  const double U = std::hypot(before.U_um.value_or(0.0), after.U_um.value_or(0.0));
  if (difference > U) return Change::better;
  return -difference > U ? Change::worse : Change::not_significant;
}

FigureComparison compared(std::string where, std::string name, const Figure& before,
                          const Figure& after) {
  return {std::move(where), std::move(name), before, after, change_between(before, after), false};
}

class Verification {
 public:
  explicit Verification(const VerificationInput& input) : input_(input) {}

  VerificationResult run() {
    require_complete(input_.uncertainty);
    require_same_points(input_.before, input_.after);
    result_.least_runs = SIZE_MAX;
    for (const DiagonalRuns& before : input_.before.diagonals)
      take_diagonal(before, counterpart(before.name));
    take_group("body diagonals", true);
    take_group("face diagonals", false);
    if (input_.volume_before) take_volume(*input_.volume_before, *input_.volume_after);
    result_.left_out = left_out(input_.uncertainty, result_.least_runs > 1);
    judge();
    return std::move(result_);
  }

 private:
  const DiagonalRuns& counterpart(const std::string& name) const {
    return *std::find_if(input_.after.diagonals.begin(), input_.after.diagonals.end(),
                         [&](const DiagonalRuns& d) { return d.name == name; });
  }

  Figure figure(const Evaluated& e, double um, FigureKind kind) {
    const std::vector<Contribution> list = contributions(input_.uncertainty, e.repetition, kind);
    const std::optional<double> U = expanded_um(list);
    if (kind == FigureKind::systematic &&
        U.value_or(-1.0) > expanded_um(result_.largest_contributions).value_or(-1.0))
      result_.largest_contributions = list;
    return {um, U};
  }

  void take_diagonal(const DiagonalRuns& before, const DiagonalRuns& after) {
    const Evaluated b = evaluate(before);
    const Evaluated a = evaluate(after);
    const auto add = [&](const char* name, FigureKind kind, double um_before, double um_after) {
      result_.figures.push_back(
          compared(before.name, name, figure(b, um_before, kind), figure(a, um_after, kind)));
    };
    add("largest", FigureKind::largest, b.largest_um, a.largest_um);
    add("E", FigureKind::systematic, b.figures.E, a.figures.E);
    if (b.repetition.both_directions) {
      add("B", FigureKind::reversal, b.figures.B, a.figures.B);
    } else {
      result_.remarks.push_back(fmt::format(
          "{}: measured in one direction only, the reversal B is unknown", before.name));
    }
    if (b.repetition.runs > 1) add("R", FigureKind::repeatability, b.figures.R, a.figures.R);
    result_.least_runs = std::min({result_.least_runs, b.repetition.runs, a.repetition.runs});
    add_curves(before, b, a);
  }

  void add_curves(const DiagonalRuns& d, const Evaluated& before, const Evaluated& after) {
    DiagonalCurves c{d.name, {}, before.curve_um, after.curve_um, {}};
    for (const DiagonalTarget& t : d.targets)
      c.distance_mm.push_back(t.distance_mm);
    if (input_.tables) {
      const std::vector<double> model = input_.tables->deviations_um(c.name, c.distance_mm);
      PredictedDiagonal p;
      double squares = 0.0;
      for (std::size_t t = 0; t < model.size(); ++t) {
        p.after_um.push_back(c.before_um[t] - model[t]);
        const double difference = c.after_um[t] - p.after_um[t];
        p.max_difference_um = std::max(p.max_difference_um, std::abs(difference));
        squares += difference * difference;
      }
      p.rms_difference_um = std::sqrt(squares / static_cast<double>(model.size()));
      c.predicted = p;
    }
    result_.curves.push_back(std::move(c));
  }

  // The largest E and B of the diagonals of one kind.
  void take_group(const char* where, bool body) {
    for (const char* name : {"E", "B"}) {
      const FigureComparison* before = nullptr;
      const FigureComparison* after = nullptr;
      for (const FigureComparison& f : result_.figures) {
        if (f.name != name || is_body_diagonal(f.where) != body) continue;
        if (before == nullptr || f.before.um > before->before.um) before = &f;
        if (after == nullptr || f.after.um > after->after.um) after = &f;
      }
      if (before == nullptr) continue;
      FigureComparison group =
          compared(where, fmt::format("{}_d", name), before->before, after->after);
      group.decides = name[0] == 'E';
      result_.figures.push_back(group);
    }
  }

  void take_volume(const VolumeFile& before, const VolumeFile& after) {
    require_same_places(before, after);
    const VolumeFigures b = aligned_volume_figures(before.points);
    const VolumeFigures a = aligned_volume_figures(after.points);
    const std::optional<double> U = input_.uncertainty.volume_um;
    FigureComparison most = compared("volume", "max", {b.max_um, U}, {a.max_um, U});
    most.decides = true;
    result_.figures.push_back(most);
    result_.figures.push_back(compared("volume", "rms", {b.rms_um, U}, {a.rms_um, U}));
    if (!U) result_.remarks.emplace_back("volume: uncertainty not stated (volume_um)");
  }

  void judge() {
    result_.ok = true;
    std::string text;
    for (const FigureComparison& f : result_.figures) {
      if (f.name == "E" && f.change == Change::worse && !input_.limit_um) {
        result_.ok = false;
        text += fmt::format("{}{} is significantly worse", text.empty() ? "" : ", ", f.where);
      }
      if (!f.decides) continue;
      const bool good =
          input_.limit_um ? f.after.most_um() <= *input_.limit_um : f.change == Change::better;
      result_.ok = result_.ok && good;
      text += fmt::format("{}{} {} {:.2f} µm before, {:.2f} µm after", text.empty() ? "" : ", ",
                          f.where, f.name, f.before.um, f.after.um);
      text += input_.limit_um ? within_limit(f, good) : words(f.change);
    }
    result_.verdict = text;
  }

  std::string within_limit(const FigureComparison& f, bool good) const {
    const double limit = *input_.limit_um;
    if (good) return fmt::format(" (within {:g} µm)", limit);
    if (f.after.um <= limit) return fmt::format(" (not within {:g} µm for certain)", limit);
    return fmt::format(" (more than {:g} µm)", limit);
  }

  static std::string words(Change change) {
    switch (change) {
      case Change::better:
        return " (better)";
      case Change::worse:
        return " (worse)";
      case Change::not_significant:
        break;
    }
    return " (no significant difference)";
  }

  const VerificationInput& input_;
  VerificationResult result_;
};

}  // namespace

double FigureComparison::reduction_percent() const {
  return improvement_percent(before.um, after.um);
}

VerificationResult verify(const VerificationInput& input) { return Verification(input).run(); }

}  // namespace volcomp::host
