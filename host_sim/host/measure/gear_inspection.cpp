#include "host_sim/host/measure/gear_inspection.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kUsed1995 = 0.92;
constexpr double kUsed2013 = 0.95;
constexpr double kLeadEnd = 0.05;  // of the width, but not more than a module
// A touch that was meant for the end of the range belongs to it, though encoders count nanometres.
constexpr double kEnd_mm = 1e-5;
constexpr double kCoverage = 0.95;  // of the evaluation range; less is reported

TraceDeviations evaluated(const FlankTrace& trace, const EvaluationRange& range,
                          const std::string& name) {
  TraceDeviations figures;
  require(evaluate_trace(trace.at, trace.deviation, {range.low - kEnd_mm, range.high + kEnd_mm},
                         figures),
          name);
  return figures;
}

std::optional<int> worse_of(const std::optional<int>& a, const std::optional<int>& b) {
  if (!a || !b) return std::nullopt;
  return std::max(*a, *b);
}

GearFigure figure_of(const InvoluteGear& gear, GearDeviation deviation, double old_um,
                     double new_um) {
  GearFigure figure{deviation, {old_um, new_um}, {}};
  for (std::size_t s = 0; s < kGearStandards.size(); ++s)
    figure.grade.at(s) = grade_of(kGearStandards.at(s), size_of(gear), deviation, figure.um.at(s));
  return figure;
}

std::vector<GearFigure> trace_figures_of(const InvoluteGear& gear, const FlankTrace& t,
                                         GearDeviation total, GearDeviation form,
                                         GearDeviation slope) {
  return {figure_of(gear, total, t.figures.total, t.figures_2013.total),
          figure_of(gear, form, t.figures.form, t.figures_2013.form),
          figure_of(gear, slope, t.figures.slope, t.figures_2013.slope)};
}

std::string trace_name(const std::string& file, const InspectedTrace& trace) {
  const char* const side = kFlankNames.at(trace.side);
  if (trace.kind == GearTraceKind::pitch)
    return fmt::format("{}: pitch of the {} flanks", file, side);
  return fmt::format("{}: {} of tooth {}, {} flank", file, name_of(trace.kind), trace.tooth + 1,
                     side);
}

class GearFile {
 public:
  GearFile(const InvoluteGear& gear, const GearPointsFile& file) : gear_(gear), file_(file) {}

  InspectedGear inspect() {
    for (const GearPoint& point : file_.points)
      sort_in(point);
    for (std::size_t s = 0; s < kGearStandards.size(); ++s)
      result_.covered.at(s) = check_size(kGearStandards.at(s), size_of(gear_)).ok();
    for (const auto& [key, points] : sorted_) {
      InspectedTrace trace{std::get<0>(key), std::get<1>(key), std::get<2>(key), points.size(), {}};
      trace.figures = trace.kind == GearTraceKind::pitch ? pitch(trace, points)
                                                         : profile_or_lead(trace, points);
      result_.traces.push_back(std::move(trace));
    }
    grade_all();
    return result_;
  }

 private:
  using Key = std::tuple<GearTraceKind, std::size_t, int>;
  using Points = std::vector<const GearPoint*>;

  void sort_in(const GearPoint& point) {
    if (point.tooth >= gear_.teeth)
      fail(point, fmt::format("tooth {}: the gear has {} teeth", point.tooth + 1, gear_.teeth));
    const std::size_t side = point.side == FlankSide::left ? 0 : 1;
    const int tooth = point.trace == GearTraceKind::pitch ? 0 : point.tooth;
    sorted_[{point.trace, side, tooth}].push_back(&point);
  }

  [[noreturn]] void fail(const GearPoint& point, const std::string& text) const {
    throw UserError(fmt::format("{}:{}: {}", file_.name, point.line, text));
  }

  [[nodiscard]] std::string place_in_file(const GearPoint& point) const {
    return fmt::format("{}:{}", file_.name, point.line);
  }

  // Roll length or x, and the deviation normal to the flank, µm.
  void add_point(const GearPoint& point, FlankTrace& trace) const {
    double mm = 0.0;
    double at = point.at;
    if (file_.has_coordinates) {
      require(deviation_from_flank(gear_, {point.side, point.tooth}, point.place, mm, at),
              place_in_file(point));
      if (point.trace == GearTraceKind::lead) at = point.place.x();
    } else {
      mm = point.deviation_mm;
    }
    trace.at.push_back(at);
    trace.deviation.push_back(kUmPerMm * mm);
  }

  // How far a tooth is round the reference circle, µm.
  [[nodiscard]] double tooth_position(const GearPoint& point) const {
    if (!file_.has_coordinates) return kUmPerMm * point.deviation_mm;
    double normal = 0.0;
    double roll = 0.0;
    const Flank flank{point.side, point.tooth};
    require(deviation_from_flank(gear_, flank, point.place, normal, roll), place_in_file(point));
    return kUmPerMm * normal / std::cos(gear_.beta_b) * gear_.r / gear_.r_b;
  }

  std::vector<GearFigure> profile_or_lead(const InspectedTrace& about, const Points& points) {
    const std::string name = trace_name(file_.name, about);
    FlankTrace trace;
    for (const GearPoint* point : points)
      add_point(*point, trace);
    if (about.kind == GearTraceKind::profile) {
      grade_profile(gear_, name, trace);
      warn_of_gaps(name, trace, profile_range(gear_, kUsed2013), "roll length");
      return trace_figures_of(gear_, trace, GearDeviation::profile, GearDeviation::profile_form,
                              GearDeviation::profile_slope);
    }
    grade_lead(gear_, name, trace);
    warn_of_gaps(name, trace, trace.range, "x");
    return trace_figures_of(gear_, trace, GearDeviation::lead, GearDeviation::lead_form,
                            GearDeviation::lead_slope);
  }

  void warn_of_gaps(const std::string& name, const FlankTrace& trace, const EvaluationRange& range,
                    const char* along) {
    const auto [low, high] = std::minmax_element(trace.at.begin(), trace.at.end());
    const double covered = std::min(*high, range.high) - std::max(*low, range.low);
    if (covered >= kCoverage * (range.high - range.low)) return;
    result_.warnings.push_back(fmt::format(
        "{}: points from {:.3f} to {:.3f} mm {}, the evaluation range is {:.3f} to {:.3f}", name,
        *low, *high, along, range.low, range.high));
  }

  std::vector<GearFigure> pitch(const InspectedTrace& about, const Points& points) const {
    std::vector<double> position(static_cast<std::size_t>(gear_.teeth), std::nan(""));
    for (const GearPoint* point : points) {
      double& tooth = position[static_cast<std::size_t>(point->tooth)];
      if (!std::isnan(tooth))
        fail(*point, fmt::format("the pitch of tooth {} is there twice", point->tooth + 1));
      tooth = tooth_position(*point);
    }
    PitchRound round{position, {}, {}, {}};
    grade_pitch(gear_, trace_name(file_.name, about), round);
    return {
        figure_of(gear_, GearDeviation::single_pitch, round.figures.single, round.figures.single),
        figure_of(gear_, GearDeviation::total_pitch, round.figures.total, round.figures.total)};
  }

  static bool decides(GearDeviation deviation) {
    return deviation == GearDeviation::profile || deviation == GearDeviation::lead ||
           deviation == GearDeviation::single_pitch || deviation == GearDeviation::total_pitch;
  }

  void grade_all() {
    for (std::size_t s = 0; s < kGearStandards.size(); ++s) {
      std::optional<int> worst = first_grade(kGearStandards.at(s));
      for (const InspectedTrace& trace : result_.traces)
        for (const GearFigure& figure : trace.figures)
          if (decides(figure.deviation)) worst = worse_of(worst, figure.grade.at(s));
      if (result_.covered.at(s)) result_.grade.at(s) = worst;
    }
  }

  const InvoluteGear& gear_;
  const GearPointsFile& file_;
  std::map<Key, Points> sorted_;
  InspectedGear result_;
};

}  // namespace

EvaluationRange profile_range(const InvoluteGear& gear, double used) {
  return {gear.roll_begin, gear.roll_begin + used * (gear.roll_end - gear.roll_begin)};
}

EvaluationRange lead_range(const InvoluteGear& gear) {
  const double end = std::min(kLeadEnd * gear.width, gear.module);
  return {end, gear.width - end};
}

GearSize size_of(const InvoluteGear& gear) { return {2.0 * gear.r, gear.module, gear.width}; }

void grade_profile(const InvoluteGear& gear, const std::string& name, FlankTrace& trace) {
  trace.range = profile_range(gear, kUsed1995);
  trace.figures = evaluated(trace, trace.range, name);
  trace.figures_2013 = evaluated(trace, profile_range(gear, kUsed2013), name);
  trace.grade_1995 = grade_of(GearStandard::iso1328_1995, size_of(gear), GearDeviation::profile,
                              trace.figures.total);
  trace.grade_2013 = grade_of(GearStandard::iso1328_2013, size_of(gear), GearDeviation::profile,
                              trace.figures_2013.total);
}

void grade_lead(const InvoluteGear& gear, const std::string& name, FlankTrace& trace) {
  trace.range = lead_range(gear);
  trace.figures = trace.figures_2013 = evaluated(trace, trace.range, name);
  const auto grade = [&](GearStandard standard) {
    return grade_of(standard, size_of(gear), GearDeviation::lead, trace.figures.total);
  };
  trace.grade_1995 = grade(GearStandard::iso1328_1995);
  trace.grade_2013 = grade(GearStandard::iso1328_2013);
}

void grade_pitch(const InvoluteGear& gear, const std::string& name, PitchRound& round) {
  require(evaluate_pitch(round.position, round.figures), name);
  const auto grade = [&](GearStandard standard) {
    return worse_of(
        grade_of(standard, size_of(gear), GearDeviation::single_pitch, round.figures.single),
        grade_of(standard, size_of(gear), GearDeviation::total_pitch, round.figures.total));
  };
  round.grade_1995 = grade(GearStandard::iso1328_1995);
  round.grade_2013 = grade(GearStandard::iso1328_2013);
}

InspectedGear inspect_gear(const InvoluteGear& gear, const GearPointsFile& file) {
  return GearFile(gear, file).inspect();
}

}  // namespace volcomp::host
