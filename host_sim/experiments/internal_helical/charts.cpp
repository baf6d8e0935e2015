#include "host_sim/experiments/internal_helical/charts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "host_sim/experiments/internal_helical/figures.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::internal_helical {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 2> kWays{"upwards", "downwards"};
constexpr double kUradPerRad = 1e6;

std::vector<double> counted(std::size_t n, double first = 1.0) {
  std::vector<double> v(n);
  std::iota(v.begin(), v.end(), first);
  return v;
}

std::vector<double> scaled(std::vector<double> v, double factor) {
  for (double& value : v)
    value *= factor;
  return v;
}

std::vector<double> nodes_of(const LearnedTables& tables) {
  std::vector<double> z;
  for (std::size_t j = 0; j < tables.stroke[0].size(); ++j)
    z.push_back(tables.z0_mm + tables.pitch_mm * static_cast<double>(j));
  return z;
}

json lines(const std::string& id, const std::string& title, json x, json y, json series) {
  return {{"type", "lines"},   {"id", id},          {"title", title},
          {"x", std::move(x)}, {"y", std::move(y)}, {"series", std::move(series)}};
}

json group(const char* id, const char* title, json charts, const std::string& note) {
  return {{"type", "group"},
          {"id", id},
          {"title", title},
          {"shared_y", true},
          {"charts", std::move(charts)},
          {"note", note}};
}

std::vector<std::string> names_of(const std::vector<double>& numbers) {
  std::vector<std::string> names;
  names.reserve(numbers.size());
  for (const double number : numbers)
    names.push_back(fmt::format("{:g}", number));
  return names;
}

json bars(const std::string& id, const std::string& title, const std::vector<double>& categories,
          json y, const std::vector<double>& before, const std::vector<double>& after) {
  return {{"type", "bars"},
          {"id", id},
          {"title", title},
          {"categories", names_of(categories)},
          {"y", std::move(y)},
          {"series",
           {{{"name", "before"}, {"values", before}}, {{"name", "after"}, {"values", after}}}}};
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
  return lines(fmt::format("lag-{}-{}", kWays.at(way), when),
               fmt::format("{}, {}", kWays.at(way), when), host::axis_label("Z", "mm"),
               host::axis_label("on the flank", "µm"),
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
  return group("lags", "Tracking errors of one pass each way", std::move(charts),
               "Both axes lag their commands along the helix; the flank shows what is left of "
               "both.");
}

json tracking_charts(const InternalHelicalResult& run) {
  const HelicalDetail& d = run.detail;
  const std::vector<double> z = nodes_of(d.tables);
  json charts = json::array();
  for (std::size_t way = 0; way < kWays.size(); ++way)
    charts.push_back(lines(fmt::format("tracking-{}", kWays[way]), kWays[way],
                           host::axis_label("Z", "mm"), host::axis_label("on the flank", "µm"),
                           {host::series_of("before", z, d.before.stroke[way]),
                            host::series_of("after", z, d.after.stroke[way])}));
  return group("tracking", "Synchronisation error over the stroke", std::move(charts),
               "Mean of all slots by node, as monitored; opposite on right flanks.");
}

json slot_chart(const InternalHelicalResult& run) {
  const HelicalDetail& d = run.detail;
  const std::vector<double> slot = counted(d.before.slot.size());
  return lines("slots", "Synchronisation error by slot", host::axis_label("slot", ""),
               host::axis_label("on the flank", "µm"),
               {host::series_of("before", slot, d.before.slot),
                host::series_of("after", slot, d.after.slot)});
}

json spectrum_along_z(const InternalHelicalResult& run) {
  const std::vector<double> wavelength(kWavelengths_mm.begin(), kWavelengths_mm.end());
  return bars("along-z", "Spectrum along Z, by wavelength in mm", wavelength,
              host::axis_label("amplitude on the flank", "µm"), run.detail.before.along,
              run.detail.after.along);
}

json spectrum_around_c(const InternalHelicalResult& run) {
  json chart =
      bars("around-c", "Spectrum around C, by order", counted(run.detail.before.around.size()),
           host::axis_label("amplitude on the flank", "µm"), run.detail.before.around,
           run.detail.after.around);
  chart["note"] = fmt::format("From the means of the slots: an order q of C shows at |q − {} m|.",
                              run.gear.teeth);
  return chart;
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
  json series = host::series_of("median of the seeds", counted(median.size()), median);
  series["band"] = {{"lo", low}, {"hi", high}};
  json chart =
      lines("learning", "Learning: synchronisation error, rms on the flank",
            host::axis_label("round", ""), host::axis_label("rms", "µm"), json::array({series}));
  chart["note"] = fmt::format(
      "One update after every {} rounds. What stays is new in every pass; w = 0.5 halves the rest.",
      kRoundsPerUpdate);
  return chart;
}

json stroke_table_chart(const InternalHelicalResult& run) {
  const LearnedTables& t = run.detail.tables;
  const std::vector<double> z = nodes_of(t);
  json chart = lines("table-stroke", "Learned table T1: offset of C over Z",
                     host::axis_label("Z", "mm"), host::axis_label("offset of C", "µrad"),
                     {host::series_of(kWays[0], z, scaled(t.stroke[0], kUradPerRad)),
                      host::series_of(kWays[1], z, scaled(t.stroke[1], kUradPerRad))});
  chart["note"] = fmt::format("For {:g} mm/s only.", run.job.feed_mm_per_s);
  return chart;
}

json slot_table_chart(const InternalHelicalResult& run) {
  const std::vector<double>& slot = run.detail.tables.slot;
  return lines(
      "table-slot", "Learned table T2: offset of C by slot", host::axis_label("slot", ""),
      host::axis_label("offset of C", "µrad"),
      json::array({host::series_of("T2", counted(slot.size()), scaled(slot, kUradPerRad))}));
}

json single_pitch_chart(const InternalHelicalResult& run, std::size_t side) {
  const auto pitches = [side](const GroundGear& gear) {
    const HelicalPitch& pitch = gear.inspection.pitch.at(side);
    std::vector<double> single(pitch.position.size());
    host::require(single_pitches({pitch.position.data(), pitch.position.size()},
                                 {single.data(), single.size()}),
                  "pitch");
    return single;
  };
  const SeedResult& first = run.seed.front();
  const std::vector<double> before = pitches(first.before);
  json chart =
      bars(fmt::format("single-pitch-{}", kHelicalSideNames.at(side)),
           fmt::format("Single pitch, {} flanks", kHelicalSideNames.at(side)),
           counted(before.size()), host::axis_label("f_pt", "µm"), before, pitches(first.after));
  chart["note"] = fmt::format("Largest {:.1f} µm before, {:.1f} µm after.",
                              first.before.inspection.pitch.at(side).figures.single,
                              first.after.inspection.pitch.at(side).figures.single);
  return chart;
}

json cumulative_pitch_charts(const InternalHelicalResult& run) {
  const SeedResult& first = run.seed.front();
  json charts = json::array();
  for (std::size_t side = 0; side < kHelicalSides.size(); ++side) {
    const auto position = [side](const GroundGear& gear) {
      return gear.inspection.pitch.at(side).position;
    };
    const std::vector<double> slot = counted(position(first.before).size());
    charts.push_back(lines(fmt::format("pitch-{}", kHelicalSideNames[side]),
                           fmt::format("{} flanks", kHelicalSideNames[side]),
                           host::axis_label("slot", ""),
                           host::axis_label("cumulative pitch deviation", "µm"),
                           {host::series_of("before", slot, position(first.before)),
                            host::series_of("after", slot, position(first.after))}));
  }
  return group("pitch", "Cumulative pitch of all slots", std::move(charts),
               "F_p is the height of a curve. What stays is run-out and the error of C that its "
               "encoder does not see.");
}

json profile_charts(const InternalHelicalResult& run) {
  const SeedResult& first = run.seed.front();
  json charts = json::array();
  for (std::size_t i = 0; i < first.before.inspection.profile.size(); ++i) {
    const HelicalProfile& before = first.before.inspection.profile[i];
    const HelicalProfile& after = first.after.inspection.profile[i];
    charts.push_back(lines(
        fmt::format("profile-{}-{}", before.slot + 1, kHelicalSideNames.at(before.side)),
        fmt::format("slot {}, {}: F_α {:.1f} → {:.1f} µm", before.slot + 1,
                    kHelicalSideNames.at(before.side), before.figures.total, after.figures.total),
        host::axis_label("roll length, tip first", "mm"), host::axis_label("deviation", "µm"),
        {host::series_of("before", run.roll_length, about_its_mean(before.deviation)),
         host::series_of("after", run.roll_length, about_its_mean(after.deviation))}));
  }
  return group("profile", "Profile at mid face", std::move(charts),
               "Transverse, + = excess material. The slope of the wheel stays; the ripple of Z, "
               "half a wave within the line of contact, goes.");
}

}  // namespace volcomp::internal_helical
