#include "host_sim/experiments/face_gear/repeatability.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/face_gear/figures.hpp"
#include "host_sim/experiments/face_gear/repeatability_bench.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/range_of_draws.hpp"
#include "host_sim/host/report/shared_progress.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::face_gear {
namespace {

using nlohmann::json;

constexpr int kRepeats = 5;
constexpr double kMiddle_mm = 250.0;  // of the travels of X and Z; the paper's zero lies there
constexpr double kRing_mm = 40.0;     // radius of the bore, chosen

// What stands there, and where it is touched.
struct Place {
  std::unique_ptr<sim::Artefact> artefact;
  StraightTouch touch;
};

Place on_plate(std::size_t axis, double at) {
  StraightTouch touch{Vec3(kMiddle_mm, 0.0, kMiddle_mm),
                      Vec3::Unit(static_cast<Eigen::Index>(axis))};
  touch.surface(static_cast<Eigen::Index>(axis)) = at;
  return {std::make_unique<Plate>(axis, at), touch};
}

std::vector<Place> along(std::size_t axis, double zero, double from, double to, double step) {
  std::vector<Place> places;
  const int count = static_cast<int>(std::lround((to - from) / step)) + 1;
  places.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    places.push_back(on_plate(axis, zero + from + step * i));
  return places;
}

std::vector<Place> in_ring() {
  constexpr int kTouches = 36;  // every 10°, 0° to 350°
  const Vec3 middle(kMiddle_mm, 0.0, kMiddle_mm);
  std::vector<Place> places;
  for (int i = 0; i < kTouches; ++i) {
    const double angle = 2.0 * kPi * i / kTouches;
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    places.push_back({std::make_unique<Ring>(kRing_mm, middle), {middle + kRing_mm * out, -out}});
  }
  return places;
}

// The paper prints ranges of X and Y, steps of none and no range of Z.
std::vector<Place> places_of(std::size_t task) {
  constexpr double kStepX_mm = 10.0;
  constexpr double kStep_mm = 5.0;
  switch (task) {
    case 0:
      return along(0, kMiddle_mm, -140.0, 70.0, kStepX_mm);
    case 1:
      return along(1, 0.0, -20.0, 30.0, kStep_mm);
    case 2:
      return along(2, kMiddle_mm, -20.0, 30.0, kStep_mm);
    default:
      return in_ring();
  }
}

// Round after round, as the paper's five sets. Largest distance from the mean of a place.
double largest_from_mean(RepeatabilityBench& bench, const std::vector<Place>& places, bool anew) {
  std::vector<std::array<double, kRepeats>> reading(places.size());
  for (std::size_t round = 0; round < kRepeats; ++round) {
    if (anew) bench.deploy_arm();
    for (std::size_t i = 0; i < places.size(); ++i)
      reading[i].at(round) = bench.touch(*places[i].artefact, places[i].touch);
  }
  double largest = 0.0;
  for (const std::array<double, kRepeats>& of_place : reading) {
    double mean = 0.0;
    for (const double r : of_place)
      mean += r / kRepeats;
    for (const double r : of_place)
      largest = std::max(largest, std::abs(r - mean));
  }
  return largest;
}

RepeatabilityOnce one_machine(const host::MachineFile& file, const FaceGearOptions& options) {
  const FaceHall hall{file,
                      make_yk7280_truth(file, options.seed),
                      {},
                      {},
                      {},
                      options.make_axes,
                      options.cycle_hz,
                      options.seed,
                      scatter_of(options)};
  RepeatabilityBench bench(hall);
  RepeatabilityOnce once;
  for (std::size_t task = 0; task < kRepeatabilityTasks.size(); ++task) {
    const std::vector<Place> places = places_of(task);
    once.arm_stays.at(task) = largest_from_mean(bench, places, false);
    once.arm_anew.at(task) = largest_from_mean(bench, places, true);
  }
  return once;
}

// Every place is touched from one side only, so neither lobes nor hysteresis nor a bending stylus
// would change how far its readings differ: they are not simulated here.
std::string probe_of_bench(const FaceGearOptions& options) {
  const sim::ProbeClass& probe = sim::kProbeClasses.at(options.probe);
  const FaceScatter scatter = scatter_of(options);
  return fmt::format(
      "Probe {}: 2σ = {:g} µm in one direction, scales of the slides read to {:g} µm: {:.2f} µm "
      "(1σ) "
      "a touch.",
      probe.name, probe.repeatability_2s_um, kUmPerMm * scatter.slide_step_mm,
      kUmPerMm * scatter.sigma_mm());
}

json repeatability_table(const RepeatabilityResult& r) {
  json rows = json::array();
  for (std::size_t task = 0; task < kRepeatabilityTasks.size(); ++task) {
    const RepeatabilityTask& t = kRepeatabilityTasks.at(task);
    json row = {t.name, t.where, t.paper_um};
    for (const auto member : {&RepeatabilityOnce::arm_stays, &RepeatabilityOnce::arm_anew}) {
      std::vector<double> values;
      for (const RepeatabilityOnce& m : r.measurement)
        values.push_back((m.*member).at(task));
      const host::RangeOfDraws range = host::range_of_draws(values);
      for (const double um : {range.median, range.least, range.most})
        row.push_back(um);
    }
    rows.push_back(row);
  }
  json made = host::table_section(
      fmt::format("Largest distance of {} readings from their mean, {} machines", kRepeats,
                  r.measurement.size()),
      {host::plain_column("along", "along"), host::plain_column("touched", "touched"),
       host::column("paper", "µm", 1, "paper_um"), host::column("median", "µm", 2, "median_um"),
       host::column("least", "µm", 2, "least_um"), host::column("most", "µm", 2, "most_um"),
       host::column("arm anew, median", "µm", 2, "anew_median_um"),
       host::column("least", "µm", 2, "anew_least_um"),
       host::column("most", "µm", 2, "anew_most_um")},
      rows);
  made["name"] = "repeatability";
  return host::in_summary(host::with_id(
      "repeatability", std::move(made),
      fmt::format("{} The paper says neither how far apart its places are nor over how much of Z: "
                  "chosen, as the ring of {:g} mm.",
                  probe_of_bench(r.options), 2.0 * kRing_mm)));
}

json repeatability_histogram(const RepeatabilityResult& r) {
  json series = json::array();
  for (std::size_t task = 0; task < kRepeatabilityTasks.size(); ++task) {
    std::vector<double> values;
    for (const RepeatabilityOnce& m : r.measurement)
      values.push_back(m.arm_stays.at(task));
    series.push_back({{"name", kRepeatabilityTasks.at(task).name}, {"values", values}});
  }
  return host::with_id("histogram", {{"type", "histogram"},
                                     {"title", "Largest distance from the mean, the arm stays"},
                                     {"x", host::axis_label("largest distance", "µm")},
                                     {"series", series}});
}

}  // namespace

RepeatabilityResult run_repeatability(const FaceGearOptions& options, std::size_t count,
                                      std::size_t threads, const host::Progress& progress) {
  RepeatabilityResult result;
  result.options = options;
  result.inputs = {host::hashed_file("machine file", options.machine)};
  const host::MachineFile file = host::read_machine_file(options.machine);
  if (!file.probe) throw host::UserError(file.path + ": the machine has no [probe]");
  result.measurement.resize(count);
  host::SharedProgress shared(progress, count);
  host::in_parallel(count, threads, [&](std::size_t i) {
    FaceGearOptions one = options;
    one.seed += i;
    result.measurement[i] = one_machine(file, one);
    shared.show(i, 1.0, fmt::format("machine {} of {}", i + 1, count));
  });
  progress(1.0, "done");
  return result;
}

nlohmann::json repeatability_document(const RepeatabilityResult& r, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = "YK7280: how well touches of one point repeat";
  parts.subtitle = "The experiments of section 3.3; every touch through drives, bus and node";
  parts.before_after = repeatability_table(r);
  parts.plots = json::array({repeatability_histogram(r)});
  host::Origins origins;
  origins.settings = {{"seeds", fmt::format("{} to {}", r.options.seed,
                                            r.options.seed + r.measurement.size() - 1)}};
  origins.inputs = r.inputs;
  origins.instruments = {probe_of_bench(r.options),
                         fmt::format("swing arm: repeats within {:g} µm where it is deployed anew",
                                     kUmPerMm * kArmRepeatability_mm)};
  origins.chosen = {kChosenText, "places of the plate, range along Z, ring"};
  parts.provenance = host::provenance(run, origins);
  return host::report_document(std::move(parts));
}

std::string repeatability_summary(const RepeatabilityResult& r) {
  return host::terminal_text(repeatability_document(r, {}));
}

nlohmann::json repeatability_figures(const RepeatabilityResult& r) {
  return {{"version", host::kVersion},
          {"machines", r.measurement.size()},
          {"seed", r.options.seed},
          {"probe", sim::kProbeClasses.at(r.options.probe).name},
          {"repeatability", host::figures_of_table(repeatability_table(r))}};
}

}  // namespace volcomp::face_gear
