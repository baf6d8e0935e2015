#include "host_sim/experiments/internal_helical/figures.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/experiments/internal_helical/grinding_job.hpp"
#include "host_sim/experiments/internal_helical/signals.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/version.hpp"

namespace volcomp::internal_helical {
namespace {

using nlohmann::json;

constexpr double kSyncGain = 5.0;        // by which the error must fall in six updates
constexpr double kRegenerated_nm = 1.0;  // limits against the exact envelope
constexpr double kSingle_nm = 5.0;
constexpr double kAll_nm = 10.0;
constexpr int kSeedsForMedians = 16;
constexpr std::size_t kLeft = 0;
constexpr std::size_t kRight = 1;

template <class Value>
Spread over_seeds(const InternalHelicalResult& run, const Value& value) {
  std::vector<double> v;
  for (const SeedResult& seed : run.seed)
    v.push_back(value(seed));
  std::sort(v.begin(), v.end());
  const std::size_t n = v.size();
  return {0.5 * (v[(n - 1) / 2] + v[n / 2]), v.front(), v.back()};
}

const GroundGear& gear_of(const SeedResult& seed, bool after) {
  return after ? seed.after : seed.before;
}

json spread_figures(const Spread& s) {
  return {{"median", s.median}, {"min", s.min}, {"max", s.max}};
}

json range_figures(const GearRow::Range& range) { return json::array({range.over, range.to}); }

json grade_figures(const GearGrade& g, const HelicalMeasure& m) {
  const bool old = g.standard == GearStandard::iso1328_1995;
  json j{{"deviation", m.name},
         {"state", m.after ? "after" : "before"},
         {"value_um", g.value_um},
         {"edition", old ? "ISO 1328-1:1995" : "ISO 1328-1:2013"},
         {"rounding", g.rounding == LimitRounding::rounded ? "rounded" : "unrounded"},
         {"grade", g.grade ? json(*g.grade) : json(nullptr)}};
  if (m.side[0] != '\0') j["side"] = m.side;
  if (old)
    j["row"] = {{"diameter_mm", range_figures(g.row.diameter)},
                {"module_mm", range_figures(g.row.module)},
                {"width_mm", range_figures(g.row.width)}};
  return j;
}

bool geometry_ok(const GeometryCheck& g) {
  return g.regenerated_nm < kRegenerated_nm && g.single_nm <= kSingle_nm && g.all_nm <= kAll_nm;
}

}  // namespace

// Widens the range of the independent simulation by 25 %, half of it on each side.
EvaluationRange HelicalMeasure::allowed() const {
  const double more = 0.125 * (specified.high - specified.low);
  return {specified.low - more, specified.high + more};
}

bool HelicalMeasure::ok() const {
  const EvaluationRange range = allowed();
  return found.median >= range.low && found.median <= range.high;
}

std::vector<HelicalMeasure> helical_measures(const InternalHelicalResult& run) {
  const auto total = [&run](std::size_t side, bool after) {
    return over_seeds(run, [=](const SeedResult& s) {
      return gear_of(s, after).inspection.pitch.at(side).figures.total;
    });
  };
  const auto single = [&run](std::size_t side, bool after) {
    return over_seeds(run, [=](const SeedResult& s) {
      return gear_of(s, after).inspection.pitch.at(side).figures.single;
    });
  };
  const auto profile = [&run](bool after) {
    return over_seeds(
        run, [after](const SeedResult& s) { return gear_of(s, after).inspection.F_alpha; });
  };
  constexpr GearDeviation kTotal = GearDeviation::total_pitch;
  constexpr GearDeviation kSingle = GearDeviation::single_pitch;
  constexpr GearDeviation kProfile = GearDeviation::profile;
  std::vector<HelicalMeasure> measures{
      {"Fp", "right", false, kTotal, total(kRight, false), {28.1, 32.3}, 28.8},
      {"Fp", "right", true, kTotal, total(kRight, true), {22.8, 26.6}, 24.1},
      {"Fp", "left", false, kTotal, total(kLeft, false), {24.1, 27.1}, 27.4},
      {"Fp", "left", true, kTotal, total(kLeft, true), {18.2, 20.8}, 17.2},
      {"fp", "right", false, kSingle, single(kRight, false), {5.4, 7.9}, 7.9},
      {"fp", "right", true, kSingle, single(kRight, true), {3.2, 5.9}, 6.2},
      {"fp", "left", false, kSingle, single(kLeft, false), {4.7, 8.2}, 5.8},
      {"fp", "left", true, kSingle, single(kLeft, true), {3.4, 5.0}, 3.6},
      {"Fa", "", false, kProfile, profile(false), {10.0, 11.7}, 11.3},
      {"Fa", "", true, kProfile, profile(true), {6.7, 8.7}, 7.3}};
  for (HelicalMeasure& m : measures)
    m.same_gear = is_of_the_paper(run.job);
  return measures;
}

Spread sync_spread(const InternalHelicalResult& run, bool after) {
  return over_seeds(run, [after](const SeedResult& s) { return gear_of(s, after).sync_rms_um; });
}

Spread z_peak_spread(const InternalHelicalResult& run, bool after) {
  return over_seeds(run, [after](const SeedResult& s) { return gear_of(s, after).z_peak_mm; });
}

std::vector<double> learning_curve(const InternalHelicalResult& run) {
  std::vector<double> curve;
  for (std::size_t round = 0; round < run.seed.front().learning_um.size(); ++round)
    curve.push_back(
        over_seeds(run, [round](const SeedResult& s) { return s.learning_um[round]; }).median);
  return curve;
}

WrongWay wrong_way(const InternalHelicalResult& run) {
  const auto after = [&run](const char* name) {
    double least = 1e300;
    for (const HelicalMeasure& m : helical_measures(run)) {
      if (m.after && std::string(m.name) == name) least = std::min(least, m.found.median);
    }
    return least;
  };
  switch (run.options.way) {
    case LearningWay::c_alone:
      return {"F_p", 80.0, after("Fp")};
    case LearningWay::one_table:
      return {"synchronisation RMS", 1.2, sync_spread(run, true).median};
    case LearningWay::coarse:
      return {"F_alpha", 9.5, after("Fa")};
    case LearningWay::right:
      break;
  }
  return {"", 0.0, 0.0};
}

GearGrade helical_grade(const host::GrindingFile& job, const HelicalMeasure& measure,
                        GearStandard standard) {
  GearGrade grade;
  host::require(grade_gear(standard, LimitRounding::rounded,
                           {2.0 * job.gear.r, job.gear.module, job.width_mm}, measure.kind,
                           measure.found.median, grade),
                "grade");
  return grade;
}

host::Verdict internal_helical_verdict(const InternalHelicalResult& run) {
  const double before = sync_spread(run, false).median;
  const double after = sync_spread(run, true).median;
  if (run.options.way != LearningWay::right) {
    const WrongWay wrong = wrong_way(run);
    return {false, fmt::format(
                       "Learned the wrong way ({}): {} is {:.1f} µm after it, {} {:.1f} µm.",
                       kLearningWays.at(static_cast<std::size_t>(run.options.way)), wrong.what,
                       wrong.found, wrong.beyond() ? "beyond" : "yet not beyond", wrong.threshold)};
  }
  const bool same = is_of_the_paper(run.job);
  const bool scatters = run.options.scatters();
  const bool judged = same && scatters && run.options.seeds >= kSeedsForMedians;
  int outside = 0;
  for (const HelicalMeasure& m : helical_measures(run))
    outside += judged && !m.ok() ? 1 : 0;
  const bool learned = before >= kSyncGain * after;
  const std::string ranges =
      !same          ? "ranges are known of the gear of the paper only"
      : !scatters    ? "the specified ranges are those of medians with noise"
      : !judged      ? fmt::format("medians are judged from {} seeds on", kSeedsForMedians)
      : outside == 0 ? "all medians lie within the specified ranges"
                     : fmt::format("{} medians lie outside", outside);
  const bool geometry = !same || geometry_ok(run.geometry);
  return {outside == 0 && learned && geometry,
          fmt::format("Z and C are out of step by {:.2f} µm rms on the flank before, {:.2f} after "
                      "{} updates ({:.1f} times less); {}{}.",
                      before, after, run.options.updates, before / after, ranges,
                      geometry ? "" : "; the first order misses the exact envelope")};
}

json geometry_figures(const InternalHelicalResult& run) {
  return {{"regenerated_flank_nm", run.geometry.regenerated_nm},
          {"first_order_vs_exact_nm",
           {{"single", run.geometry.single_nm}, {"all", run.geometry.all_nm}}},
          {"lags_um",
           {{"z", run.lags.z_um}, {"c", run.lags.c_um}, {"together", run.lags.together_um}}}};
}

json internal_helical_figures(const InternalHelicalResult& run,
                              const std::vector<std::string>& tables) {
  json j = geometry_figures(run);
  for (const HelicalMeasure& m : helical_measures(run)) {
    json& place = m.side[0] == '\0' ? j[m.name] : j[m.name][m.side];
    place[m.after ? "after" : "before"] = spread_figures(m.found);
    for (const GearStandard standard : {GearStandard::iso1328_1995, GearStandard::iso1328_2013})
      j["grades"].push_back(grade_figures(helical_grade(run.job, m, standard), m));
  }
  j["sync_rms_um"] = {{"before", spread_figures(sync_spread(run, false))},
                      {"after", spread_figures(sync_spread(run, true))}};
  j["signals"] = signal_figures(run);
  j["learning_um"] = learning_curve(run);
  j["z_peak_mm"] = {{"before", spread_figures(z_peak_spread(run, false))},
                    {"after", spread_figures(z_peak_spread(run, true))}};
  j["way"] = kLearningWays.at(static_cast<std::size_t>(run.options.way));
  if (run.options.way != LearningWay::right) {
    const WrongWay w = wrong_way(run);
    j["wrong"] = {{"what", w.what}, {"found_um", w.found}, {"threshold_um", w.threshold}};
  }
  j["tables_written"] = tables;
  j["seeds"] = run.options.seeds;
  j["version"] = host::kVersion;
  return j;
}

}  // namespace volcomp::internal_helical
