#include "host_sim/host/measure/gear_inspection.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kCoverage = 0.95;           // of the evaluation range; less is reported
constexpr std::ptrdiff_t kPoints2013 = 150;  // of a filtered trace; quoted from memory

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

// `figure` of one tooth more.
void add_tooth(const GearFigure& figure, ToothSummary& summary) {
  ++summary.teeth;
  for (std::size_t s = 0; s < kGearStandards.size(); ++s) {
    const double um = figure.um.at(s);
    double& mean = summary.mean_um.at(s);
    mean += (um - mean) / static_cast<double>(summary.teeth);
    double& worst = summary.worst_um.at(s);
    if (std::abs(um) > std::abs(worst)) worst = um;
  }
}

std::vector<ToothSummary> summaries_of(const std::vector<InspectedTrace>& traces) {
  std::map<std::tuple<GearTraceKind, std::size_t, GearDeviation>, ToothSummary> sorted;
  for (const InspectedTrace& trace : traces)
    for (const GearFigure& figure : trace.figures) {
      ToothSummary& summary = sorted[{trace.kind, trace.side, figure.deviation}];
      summary.kind = trace.kind;
      summary.side = trace.side;
      summary.deviation = figure.deviation;
      add_tooth(figure, summary);
    }
  std::vector<ToothSummary> several;
  for (const auto& [key, summary] : sorted)
    if (summary.teeth > 1) several.push_back(summary);
  return several;
}

class GearFile {
 public:
  GearFile(const InvoluteGear& gear, const GearPointsFile& file, const InspectSettings& settings)
      : gear_(gear), file_(file) {
    result_.settings = settings;
  }

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
    result_.teeth = summaries_of(result_.traces);
    if (result_.settings.ball_mm > 0.0) result_.run_out = run_out();
    result_.spans = std::move(spans_);
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
    const EvaluationRange range = about.kind == GearTraceKind::profile
                                      ? profile_range(gear_, kRollUsed2013)
                                      : lead_range(gear_);
    if (result_.settings.filter) filter(name, range, trace);
    if (about.kind == GearTraceKind::profile) {
      grade_profile(gear_, name, trace);
      warn_of_gaps(name, trace, range, "roll length");
      return trace_figures_of(gear_, trace, GearDeviation::profile, GearDeviation::profile_form,
                              GearDeviation::profile_slope);
    }
    grade_lead(gear_, name, trace);
    warn_of_gaps(name, trace, range, "x");
    return trace_figures_of(gear_, trace, GearDeviation::lead, GearDeviation::lead_form,
                            GearDeviation::lead_slope);
  }

  void filter(const std::string& name, const EvaluationRange& range, FlankTrace& trace) {
    filter_as_2013(trace, range, name);
    const auto inside = std::count_if(trace.at.begin(), trace.at.end(), [&](double at) {
      return at >= range.low - kTraceEnd_mm && at <= range.high + kTraceEnd_mm;
    });
    if (inside >= kPoints2013) return;
    result_.warnings.push_back(
        fmt::format("{}: {} places in the evaluation range, the edition of 2013 asks for {}", name,
                    inside, kPoints2013));
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

  std::vector<GearFigure> pitch(const InspectedTrace& about, const Points& points) {
    std::vector<double> position(static_cast<std::size_t>(gear_.teeth), std::nan(""));
    for (const GearPoint* point : points) {
      double& tooth = position[static_cast<std::size_t>(point->tooth)];
      if (!std::isnan(tooth))
        fail(*point, fmt::format("the pitch of tooth {} is there twice", point->tooth + 1));
      tooth = tooth_position(*point);
    }
    PitchRound round{position, {}, {}, {}};
    grade_pitch(gear_, trace_name(file_.name, about), round);
    positions_.at(about.side) = round.position;
    PitchSpan span{about.side, largest_pitch_span(round.position.size()), 0.0};
    require(cumulative_pitch(round.position, span.pitches, span.um), trace_name(file_.name, about));
    spans_.push_back(span);
    return {
        figure_of(gear_, GearDeviation::single_pitch, round.figures.single, round.figures.single),
        figure_of(gear_, GearDeviation::total_pitch, round.figures.total, round.figures.total)};
  }

  // Space k lies between the left flank of tooth k and the right flank of the tooth after it.
  [[nodiscard]] InspectedRunOut run_out() const {
    if (positions_[0].empty() || positions_[1].empty())
      throw UserError(fmt::format("{}: run-out needs the pitch of both sides", file_.name));
    std::vector<double> left = positions_[0];
    std::vector<double> right = positions_[1];
    std::rotate(right.begin(), right.begin() + 1, right.end());
    // From the reference circle to the line of action.
    for (std::vector<double>* side : {&left, &right})
      for (double& um : *side)
        um *= gear_.r_b / gear_.r;
    const BallInSpace ball{gear_.teeth,       gear_.module, gear_.pressure_angle,
                           gear_.helix_angle, 0.0,          result_.settings.ball_mm};
    InspectedRunOut out;
    out.ball_mm = ball.diameter;
    BallSeat seat;
    const std::string name = fmt::format("{}: a ball of {:g} mm", file_.name, ball.diameter);
    require(ball_seat(ball, seat), name);
    out.radius_mm = seat.radius;
    std::vector<double> radial(left.size());
    require(volcomp::run_out(ball, left, right, radial, out.um), name);
    for (std::size_t s = 0; s < kGearStandards.size(); ++s)
      out.grade.at(s) =
          grade_of(kGearStandards.at(s), size_of(gear_), GearDeviation::runout, out.um.total);
    return out;
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
          if (decides(figure.deviation)) worst = worse_grade(worst, figure.grade.at(s));
      if (result_.covered.at(s)) result_.grade.at(s) = worst;
    }
  }

  const InvoluteGear& gear_;
  const GearPointsFile& file_;
  std::map<Key, Points> sorted_;
  std::array<std::vector<double>, 2> positions_;  // of the pitch, by kFlankSides, µm
  std::vector<PitchSpan> spans_;
  InspectedGear result_;
};

}  // namespace

InspectedGear inspect_gear(const InvoluteGear& gear, const GearPointsFile& file,
                           const InspectSettings& settings) {
  return GearFile(gear, file, settings).inspect();
}

}  // namespace volcomp::host
