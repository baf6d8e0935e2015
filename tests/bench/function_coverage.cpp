// How often ± 1.96 u holds an error function that is identified: simulated campaigns of a plan
// whose truth is known, function by function.
//
//   volcomp_function_coverage [PLAN] [--campaigns 1000] [--seed 1]
//
// PLAN: four stations of a tracer about the XYFZ machine. Its truth is such as the plan states it:
// functions that its splines can follow, the scatter of readings, tips, scales and curvatures as
// stated, all else anywhere. The same without a stated curvature, with functions of any form.
//
// Prints a row a function: least … most over its places (all together), percent. Neighbouring
// places of a campaign go together, so that all places of it count as one for the sampling error.
// Ends with 1 where a share is beyond 93 to 97 % by more than 3.5 standard deviations.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <Eigen/QR>

#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"
#include "tests/bench/coverage_shares.hpp"

namespace volcomp::test {
namespace {

using namespace host::identify;

constexpr double kFactor = 1.96;

// Standard normal numbers of a campaign that belong to no reading.
double of_truth(std::uint64_t seed, std::size_t campaign, Index number) {
  return normal(
      seed, {static_cast<std::uint32_t>(RandomStream::set_up), static_cast<std::uint32_t>(campaign),
             kCommon, kCommon - static_cast<std::uint32_t>(number)});
}

// What is true in a campaign: everything known beforehand misses by its σ times a random number.
class Truths {
 public:
  explicit Truths(const Equations& equations)
      : equations_(equations), start_(equations.start()), known_(rows(equations, start_)) {}

  [[nodiscard]] Estimate of(std::uint64_t seed, std::size_t campaign) const {
    constexpr double kError_mm = 10e-3;
    constexpr double kError_rad = 20e-6;
    constexpr double kPlace_mm = 1.0;
    const Unknowns& unknowns = equations_.unknowns();
    Estimate truth = start_;
    for (Index i = 0; i < unknowns.size(); ++i) {
      const double size = i >= unknowns.of_machine() ? kPlace_mm
                          : unknowns.is_angle(i)     ? kError_rad
                                                     : kError_mm;
      truth.x(i) += size * of_truth(seed, campaign, i);
    }
    VectorXd misses(known_.rows());
    for (Index i = 0; i < misses.size(); ++i)
      misses(i) = of_truth(seed, campaign, unknowns.size() + i);
    truth.x += solver_.solve(misses - known_ * truth.x);
    return truth;
  }

 private:
  static MatrixXd rows(const Equations& equations, const Estimate& start) {
    std::vector<VectorXd> found;
    equations.visit_known(start, {}, [&](const VectorXd& row, double) { found.push_back(row); });
    MatrixXd rows(static_cast<Index>(found.size()), equations.unknowns().size());
    for (Index i = 0; i < rows.rows(); ++i)
      rows.row(i) = found[static_cast<std::size_t>(i)].transpose();
    return rows;
  }

  const Equations& equations_;
  Estimate start_;
  MatrixXd known_;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver_{known_};
};

// Readings of a truth, with the scatter that is stated.
Problem measured(const Equations& equations, const Estimate& truth, const Noise& noise) {
  Problem problem = equations.problem();
  for (SetUp& s : problem.setups)
    s.y.clear();
  equations.visit_readings(truth,
                           [&](const ReadingPlace& at, const VectorXd& /*row*/, double residual) {
                             SetUp& s = problem.setups[at.setup];
                             const std::size_t number = s.y.size();
                             s.y.push_back(s.sigma[number] * (noise(at.setup, number) - residual));
                           });
  return problem;
}

// What is compared: a quantity of the machine at one of its places.
struct Place {
  std::size_t quantity = 0;
  double at = 0.0;
};

// At the targets of the machine file, where the tables take functions from. Where a function is 0
// by definition there is nothing to hold.
std::vector<Place> places_of(const Unknowns& unknowns, const host::MachineFile& machine) {
  constexpr double kDefined = 1e-9;
  std::vector<Place> places;
  for (std::size_t k = 0; k < unknowns.quantities().size(); ++k) {
    const Quantity& quantity = unknowns.quantities()[k];
    const bool function = quantity.kind == QuantityKind::function;
    const std::vector<double> targets =
        function ? machine.axes[quantity.axis].all_targets() : std::vector<double>{0.0};
    for (const double at : targets)
      if (unknowns.value_row(quantity, at).cwiseAbs().maxCoeff() > kDefined)
        places.push_back({k, at});
  }
  return places;
}

// Of one campaign: error over u at each place.
std::vector<double> errors_over_u(const Truths& truths, const Equations& planned,
                                  const std::vector<Place>& places, std::uint64_t seed,
                                  std::size_t campaign) {
  const Estimate truth = truths.of(seed, campaign);
  const Problem problem = measured(planned, truth, Noise(seed, campaign));
  const Equations equations(problem, true);
  const Solution solution = solve(equations, false);
  if (!solution.converged) {
    fmt::print(stderr, "campaign {}: no solution in {} steps\n", campaign, solution.steps);
    std::exit(2);
  }
  const VectorXd off = solution.estimate.x - truth.x;
  std::vector<double> errors;
  for (const Place& place : places) {
    const Unknowns& unknowns = equations.unknowns();
    const VectorXd row = unknowns.value_row(unknowns.quantities()[place.quantity], place.at);
    errors.push_back(row.dot(off) / solution.triangle.uncertainty(row));
  }
  return errors;
}

// Errors over u of many campaigns, by campaign and place.
using Campaigns = std::vector<std::vector<double>>;

// Shares of some places: at single ones, and of all together with the standard error from campaign
// to campaign.
struct PlaceShares {
  Shares places;
  double together = 0.0;
  double standard_error = 0.0;
  double spread = 0.0;  // root mean square of error over u

  [[nodiscard]] std::string text() const {
    return fmt::format("{} ± {:.1f} | {:.2f}", places.text(), 100.0 * standard_error, spread);
  }
};

PlaceShares shares_of(const Campaigns& campaigns, const std::vector<std::size_t>& own,
                      const std::vector<Place>& places) {
  PlaceShares shares;
  const double all = static_cast<double>(own.size() * campaigns.size());
  std::vector<double> of_campaign(campaigns.size(), 0.0);
  for (const std::size_t p : own) {
    std::size_t held = 0;
    for (std::size_t k = 0; k < campaigns.size(); ++k) {
      const double error = campaigns[k][p];
      const bool within = std::abs(error) <= kFactor;
      held += within ? 1U : 0U;
      of_campaign[k] += within ? 1.0 / static_cast<double>(own.size()) : 0.0;
      shares.spread += error * error / all;
    }
    shares.places.add(fmt::format("at {:g}", places[p].at), held, campaigns.size());
    shares.together += static_cast<double>(held) / all;
  }
  double squares = 0.0;
  for (const double held : of_campaign)
    squares += (held - shares.together) * (held - shares.together);
  const auto count = static_cast<double>(campaigns.size());
  shares.standard_error = std::sqrt(squares / (count - 1.0) / count);
  shares.spread = std::sqrt(shares.spread);
  return shares;
}

// A plan whose campaigns are simulated.
class SimulatedPlan {
 public:
  SimulatedPlan(const Problem& planned, const host::MachineFile& machine, std::size_t campaigns,
                std::uint64_t seed)
      : equations_(planned, true), places_(places_of(equations_.unknowns(), machine)) {
    const Truths truths(equations_);
    campaigns_.resize(campaigns);
    host::in_parallel(campaigns, host::processors(), [&](std::size_t k) {
      campaigns_[k] = errors_over_u(truths, equations_, places_, seed, k);
    });
  }

  [[nodiscard]] const std::vector<Quantity>& quantities() const {
    return equations_.unknowns().quantities();
  }
  [[nodiscard]] PlaceShares of(std::size_t quantity) const {
    return of([quantity](const Place& place) { return place.quantity == quantity; });
  }
  [[nodiscard]] PlaceShares of_functions() const {
    return of([&](const Place& place) {
      return quantities()[place.quantity].kind == QuantityKind::function;
    });
  }

 private:
  template <class Belongs>
  [[nodiscard]] PlaceShares of(const Belongs& belongs) const {
    std::vector<std::size_t> own;
    for (std::size_t p = 0; p < places_.size(); ++p)
      if (belongs(places_[p])) own.push_back(p);
    return shares_of(campaigns_, own, places_);
  }

  Equations equations_;
  std::vector<Place> places_;
  Campaigns campaigns_;
};

// All functions together, whose sampling error is the smallest: 93 to 97 % by 3.5 of it.
bool together_as_stated(const char* what, const PlaceShares& all) {
  const double room = 350.0 * all.standard_error;
  const double percent = 100.0 * all.together;
  const bool good = percent >= kLeastOfStated - room && percent <= kMostOfStated + room;
  if (!good) fmt::print(stderr, "{}: all functions held {:.1f} %\n", what, percent);
  return good;
}

// With the plan's own curvature, and with none: then functions may have any form.
bool run(const std::filesystem::path& path, std::size_t campaigns, std::uint64_t seed) {
  const MeasurementPlan plan = read_plan(path, {{}, true});
  Problem free = plan.problem;
  free.model.curvature.reset();
  const SimulatedPlan stated(plan.problem, plan.machine, campaigns, seed);
  const SimulatedPlan none(free, plan.machine, campaigns, seed);
  fmt::print("{}: {} campaigns\n\n", plan.path, campaigns);
  fmt::print("| of | curvature as stated: ± 1.96 u holds, % (together) | rms of error over u |");
  fmt::print(" no curvature stated | rms |\n|---|---|---|---|---|\n");
  bool good = true;
  for (std::size_t q = 0; q < stated.quantities().size(); ++q) {
    const std::string& name = stated.quantities()[q].name;
    const PlaceShares with = stated.of(q);
    const PlaceShares without = none.of(q);
    fmt::print("| {} | {} | {} |\n", name, with.text(), without.text());
    good = with.places.each_as_stated(campaigns, name + ", curvature as stated") && good;
    good = without.places.each_as_stated(campaigns, name + ", no curvature stated") && good;
  }
  const PlaceShares with = stated.of_functions();
  const PlaceShares without = none.of_functions();
  fmt::print("| all functions | {} | {} |\n", with.text(), without.text());
  good = together_as_stated("curvature as stated", with) && good;
  return together_as_stated("no curvature stated", without) && good;
}

}  // namespace
}  // namespace volcomp::test

int main(int argc, char** argv) {
  std::filesystem::path plan = volcomp::host::identify::bundled_plan("xyfz_tracer");
  std::size_t campaigns = 1000;
  std::uint64_t seed = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string_view name = argv[i];
    if (name.substr(0, 2) != "--") {
      plan = name;
    } else if (++i < argc) {
      const std::uint64_t value = std::strtoull(argv[i], nullptr, 10);
      if (name == "--campaigns" && value > 1) campaigns = value;
      if (name == "--seed") seed = value;
    }
  }
  return volcomp::test::run(plan, campaigns, seed) ? EXIT_SUCCESS : EXIT_FAILURE;
}
