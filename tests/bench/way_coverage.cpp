#include "tests/bench/way_coverage.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "host_sim/host/measure/whole_way/task_outputs.hpp"
#include "host_sim/host/measure/whole_way/whole_way.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"
#include "tests/host_sim/experiments/l300g/simulated_mandrel.hpp"

namespace volcomp::test {
namespace {

using namespace host;

// XYFZ with the errors of one seed. Its truth is what tables of perfect readings say, at targets:
// how they are interpolated between is no matter of readings.
struct KnownMachine {
  MachineFile file = read_machine_file(bundled_machine("xyfz"));
  sim::TrueMachine machine = sim::draw_machine(file, 3);
  Task task = line_task("0,0,0:-500,-300,-400", 6, file);
  XyfzSquareness squareness;
  TaskErrors errors;
  std::vector<double> figures;  // in the order of TaskUncertainty

  KnownMachine() {
    const sim::Campaign perfect = sim::perfect_campaign(machine, file);
    squareness = perfect.machine.squareness->measured;
    BuildOptions build;
    build.bound = false;
    const TaskOutputs outputs(perfect.machine, task, Travel::unknown);
    errors = outputs.errors(build_tables(perfect.machine, perfect.runs, build)->model);
    for (const FigureOfTask& figure : outputs.figures())
      figures.push_back(outputs.figure(figure, errors, errors));
  }
};

// The standard uncertainties of the instruments that sim::NoiseClasses draws.
CampaignStatement statement() {
  CampaignStatement s;
  s.scale_um_per_m = 0.25;
  s.straightness_gain_percent = 0.5;
  s.angle_gain_percent = 0.2;
  s.roll_urad = 2.0;
  s.straightness_wave_um = 0.3;
  s.angle_wave_urad = 0.3;
  s.lever_mm = 2.0;
  s.cosine_mrad = 0.5;
  s.growth_K = 0.1;
  s.expansion_um_per_m_K = 11.7;
  s.squareness_urad = 3.0;
  return s;
}

TaskUncertainty measured(const KnownMachine& known, const CoverageOptions& options,
                         std::size_t campaign) {
  constexpr std::size_t kRuns = 5;
  // Drift is stated nowhere: runs scatter by it, but not independently from target to target.
  sim::NoiseClasses classes;
  classes.laser.drift_mm = 0.0;
  const sim::CampaignDraw draw{options.seed + 1000, static_cast<std::uint32_t>(campaign)};
  sim::Campaign found = sim::measure_machine(known.machine, known.file, classes, kRuns, draw);
  const Noise noise(options.seed, campaign);
  const double u = *statement().squareness_urad * 1e-6;
  found.machine.squareness->measured = {known.squareness.a_xy + u * noise(0, 0),
                                        known.squareness.a_xz + u * noise(0, 1),
                                        known.squareness.a_yz + u * noise(0, 2)};
  WholeWaySettings settings;
  settings.draws = std::max<std::size_t>(100, options.draws / 2);
  settings.seed = options.seed + campaign;
  return uncertainty_of_task(found.machine, found.runs, statement(), known.task, settings,
                             [](double, const std::string&) {});
}

// By first order and by draws, each component at each place but the first, where nothing is
// uncertain; then the figures that have an interval.
constexpr std::size_t kComponents = 15;

std::vector<Held> held_of(const KnownMachine& known, const TaskUncertainty& u) {
  std::vector<Held> first_order, held;
  for (std::size_t k = 0; k < kComponents; ++k) {
    const std::size_t place = 1 + k / 3;
    const DrawnNumber& n = u.places.at(place).error.at(k % 3);
    const double truth = known.errors[place](static_cast<Eigen::Index>(k % 3));
    first_order.push_back({std::abs(n.nominal - truth) <= 1.96 * *n.first_order, true});
    held.push_back({n.low <= truth && truth <= n.high, true});
  }
  held.insert(held.begin(), first_order.begin(), first_order.end());
  for (std::size_t f = 0; f < u.figures.size(); ++f)
    if (u.figures[f].truth) held.push_back(held_by(*u.figures[f].truth, known.figures[f]));
  return held;
}

}  // namespace

bool mandrels_hold(const CoverageOptions& options) {
  constexpr const char* kName = "r_c of a mandrel, ± 2 u";
  std::vector<Coverage> row(1);
  for (const double arm_mm : {1e-3, 20e-3}) {
    l300g::MandrelBudget budget;
    budget.arm_length = arm_mm;
    const auto one = [&](std::size_t k) {
      const l300g::MandrelError e =
          l300g::mandrel_error(SwingArm{}, budget, options.seed, static_cast<std::uint32_t>(k));
      return std::vector<Held>{{e.covered(), true}};
    };
    count_held(fmt::format("arm within {} mm", arm_mm), options.campaigns, one, row);
  }
  fmt::print("| {} | {} | – |\n", kName, row[0].interval.text());
  return row[0].interval.as_stated(kName);
}

bool whole_ways_hold(const CoverageOptions& options) {
  const KnownMachine known;
  std::vector<Coverage> each(2 * kComponents + 2);
  count_held(
      "one of them", options.whole_campaigns,
      [&](std::size_t k) { return held_of(known, measured(known, options, k)); }, each);
  bool good = true;
  const auto print = [&](const char* name, std::size_t from, std::size_t to) {
    Coverage row;
    for (std::size_t i = from; i < to; ++i) {
      row.interval.add(each[i].interval);
      row.bound.add(each[i].bound);
    }
    const bool bounded = to - from == 1;
    fmt::print("| XYFZ, {} | {} | {} |\n", name, row.interval.text(),
               bounded ? fmt::format("≥ {:.1f}", row.bound.least()) : "–");
    good = (bounded ? row.interval.enough_of(kLeastOfStated, name) &&
                          row.bound.enough_of(kLeastOfStated, name)
                    : row.interval.as_stated(name)) &&
           good;
  };
  print("errors of points, first order ± 1.96 u", 0, kComponents);
  print("errors of points, draws", kComponents, 2 * kComponents);
  print("largest error on a line", 2 * kComponents, 2 * kComponents + 1);
  print("range along a line", 2 * kComponents + 1, 2 * kComponents + 2);
  return good;
}

}  // namespace volcomp::test
