#include "host_sim/experiments/internal_helical/charts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "host_sim/experiments/internal_helical/figures.hpp"
#include "host_sim/host/report/pitch_charts.hpp"

namespace volcomp::internal_helical {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 2> kWays{"upwards", "downwards"};

std::vector<double> nodes_of(const LearnedTables& tables) {
  std::vector<double> z;
  for (std::size_t j = 0; j < tables.stroke[0].size(); ++j)
    z.push_back(tables.z0_mm + tables.pitch_mm * static_cast<double>(j));
  return z;
}

json before_and_after(const std::vector<double>& x, const std::vector<double>& before,
                      const std::vector<double>& after) {
  return {host::series_of("before", x, before), host::series_of("after", x, after)};
}

json bars_before_and_after(const std::vector<double>& before, const std::vector<double>& after) {
  return {host::bars_of("before", before), host::bars_of("after", after)};
}

// As profiles are drawn: the flank has no place of its own.
std::vector<double> about_its_mean(std::vector<double> v) {
  const double mean = std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  for (double& value : v)
    value -= mean;
  return v;
}

// One pass within the face: what Z alone, C alone and both together are on the flank, µm.
json lag_chart(const InternalHelicalResult& run, const StrokeTrace& pass, const std::string& when) {
  std::vector<double> place;
  std::vector<double> z;
  std::vector<double> c;
  std::vector<double> both;
  constexpr std::size_t kEvery = 4;
  for (std::size_t i = 0; i < pass.at.size(); i += kEvery) {
    const LagErrors& e = pass.at[i];
    if (std::abs(e.z) > 0.5 * run.job.width_mm) continue;
    const auto flank = [&run](double e_z, double e_c) {
      return kUmPerMm *
             synchronisation_on_flank(run.gear, synchronisation_error(run.gear, e_z, e_c));
    };
    place.push_back(e.z);
    z.push_back(flank(e.e_z, 0.0));
    c.push_back(flank(0.0, e.e_c));
    both.push_back(flank(e.e_z, e.e_c));
  }
  const auto way = static_cast<std::size_t>(pass.direction);
  return host::lines_chart(
      fmt::format("lag-{}-{}", kWays.at(way), when), fmt::format("{}, {}", kWays.at(way), when),
      host::axis_label("Z", "mm"), host::axis_label("on the flank", "µm"),
      {host::series_of("Z alone", place, z), host::series_of("C alone", place, c),
       host::series_of("both", place, both)});
}

}  // namespace

json lag_charts(const InternalHelicalResult& run) {
  json charts = json::array();
  for (const StrokeTrace& pass : run.detail.pass_before)
    charts.push_back(lag_chart(run, pass, "before"));
  for (const StrokeTrace& pass : run.detail.pass_after)
    charts.push_back(lag_chart(run, pass, "after"));
  return host::chart_group(
      "lags", "Tracking errors of one pass each way", std::move(charts),
      "Both axes lag their commands along the helix; the flank shows what is left of "
      "both.");
}

json tracking_charts(const InternalHelicalResult& run) {
  const HelicalDetail& d = run.detail;
  const std::vector<double> z = nodes_of(d.tables);
  json charts = json::array();
  for (std::size_t way = 0; way < kWays.size(); ++way)
    charts.push_back(
        host::lines_chart(fmt::format("tracking-{}", kWays[way]), kWays[way],
                          host::axis_label("Z", "mm"), host::axis_label("on the flank", "µm"),
                          before_and_after(z, d.before.stroke[way], d.after.stroke[way])));
  return host::chart_group("tracking", "Synchronisation error over the stroke", std::move(charts),
                           "Mean of all slots by node, as monitored; opposite on right flanks.");
}

json slot_chart(const InternalHelicalResult& run) {
  const HelicalDetail& d = run.detail;
  const std::vector<double> slot = host::counted(d.before.slot.size());
  return host::lines_chart("slots", "Synchronisation error by slot", host::axis_label("slot", ""),
                           host::axis_label("on the flank", "µm"),
                           before_and_after(slot, d.before.slot, d.after.slot));
}

json spectrum_along_z(const InternalHelicalResult& run) {
  const HelicalDetail& d = run.detail;
  return host::bar_chart("along-z", "Spectrum along Z, by wavelength in mm",
                         std::vector<double>(kWavelengths_mm.begin(), kWavelengths_mm.end()),
                         host::axis_label("amplitude on the flank", "µm"),
                         bars_before_and_after(d.before.along, d.after.along));
}

json spectrum_around_c(const InternalHelicalResult& run) {
  const HelicalDetail& d = run.detail;
  return host::bar_chart(
      "around-c", "Spectrum around C, by order", host::counted(d.before.around.size()),
      host::axis_label("amplitude on the flank", "µm"),
      bars_before_and_after(d.before.around, d.after.around),
      fmt::format("From the means of the slots: an order q of C shows at |q − {} m|.",
                  run.gear.teeth));
}

json learning_chart(const InternalHelicalResult& run) {
  const std::vector<double> median = learning_curve(run);
  std::vector<double> low = median;
  std::vector<double> high = median;
  for (const SeedResult& seed : run.seed) {
    for (std::size_t i = 0; i < median.size(); ++i) {
      low[i] = std::min(low[i], seed.learning_um[i]);
      high[i] = std::max(high[i], seed.learning_um[i]);
    }
  }
  json series = host::series_of("median of the seeds", host::counted(median.size()), median);
  series["band"] = {{"lo", low}, {"hi", high}};
  return host::lines_chart("learning", "Learning: synchronisation error, rms on the flank",
                           host::axis_label("round", ""), host::axis_label("rms", "µm"),
                           json::array({series}),
                           fmt::format("One update after every {} rounds. What stays is new in "
                                       "every pass; w = 0.5 halves the rest.",
                                       kRoundsPerUpdate));
}

json stroke_table_chart(const InternalHelicalResult& run) {
  const LearnedTables& t = run.detail.tables;
  const auto offsets = [&t, z = nodes_of(t)](std::size_t way) {
    return host::series_of(kWays.at(way), z, host::scaled(t.stroke.at(way), host::kUradPerRad));
  };
  return host::lines_chart("table-stroke", "Learned table T1: offset of C over Z",
                           host::axis_label("Z", "mm"), host::axis_label("offset of C", "µrad"),
                           {offsets(0), offsets(1)},
                           fmt::format("For {:g} mm/s only.", run.job.feed_mm_per_s));
}

json slot_table_chart(const InternalHelicalResult& run) {
  const std::vector<double>& slot = run.detail.tables.slot;
  return host::lines_chart("table-slot", "Learned table T2: offset of C by slot",
                           host::axis_label("slot", ""), host::axis_label("offset of C", "µrad"),
                           json::array({host::series_of("T2", host::counted(slot.size()),
                                                        host::scaled(slot, host::kUradPerRad))}));
}

json single_pitch_chart(const InternalHelicalResult& run, std::size_t side) {
  const HelicalPitch& before = run.seed.front().before.inspection.pitch.at(side);
  const HelicalPitch& after = run.seed.front().after.inspection.pitch.at(side);
  return host::single_pitch_chart(kHelicalSideNames.at(side),
                                  {{"before", before.position}, {"after", after.position}},
                                  fmt::format("Largest {:.1f} µm before, {:.1f} µm after.",
                                              before.figures.single, after.figures.single));
}

json cumulative_pitch_charts(const InternalHelicalResult& run) {
  const SeedResult& first = run.seed.front();
  json charts = json::array();
  for (std::size_t side = 0; side < kHelicalSides.size(); ++side)
    charts.push_back(host::cumulative_pitch_chart(
        kHelicalSideNames.at(side), {{"before", first.before.inspection.pitch.at(side).position},
                                     {"after", first.after.inspection.pitch.at(side).position}}));
  return host::chart_group(
      "pitch", "Cumulative pitch of all slots", std::move(charts),
      "F_p is the height of a curve. What stays is run-out and the error of C that its "
      "encoder does not see.");
}

json profile_charts(const InternalHelicalResult& run) {
  const SeedResult& first = run.seed.front();
  json charts = json::array();
  for (std::size_t i = 0; i < first.before.inspection.profile.size(); ++i) {
    const HelicalProfile& before = first.before.inspection.profile[i];
    const HelicalProfile& after = first.after.inspection.profile[i];
    charts.push_back(host::lines_chart(
        fmt::format("profile-{}-{}", before.slot + 1, kHelicalSideNames.at(before.side)),
        fmt::format("slot {}, {}: F_α {:.1f} → {:.1f} µm", before.slot + 1,
                    kHelicalSideNames.at(before.side), before.figures.total, after.figures.total),
        host::axis_label("roll length, tip first", "mm"), host::axis_label("deviation", "µm"),
        before_and_after(run.roll_length, about_its_mean(before.deviation),
                         about_its_mean(after.deviation))));
  }
  return host::chart_group(
      "profile", "Profile at mid face", std::move(charts),
      "Transverse, + = excess material. The slope of the wheel stays; the ripple of Z, "
      "half a wave within the line of contact, goes.");
}

}  // namespace volcomp::internal_helical
