// What identification of a machine's errors costs on this computer: processor time, median of some
// repetitions with the least and the most, and memory beyond the readings.
//
//   volcomp_identification_bench tests/data/plan_plate.toml [--repetitions 5] [--goals]
//
// A ball plate in twelve placements, and tracers that read as often as they like; readings follow
// from errors that are known, with noise. Ends with 1 where memory grows with the number of
// readings; with --goals also where a time is over its goal, which depends on the computer and on
// what else it does.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "host_sim/host/measure/identify/consistency.hpp"
#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"
#include "host_sim/host/measure/identify/rank.hpp"
#include "host_sim/host/measure/identify/volume.hpp"

// Memory in use and its peak. Of malloc, which Eigen calls, not of operator new, which calls it.
namespace {
std::atomic<std::size_t> in_use{0};
std::atomic<std::size_t> most_in_use{0};

void* counted(void* p) {
  if (p == nullptr) return p;
  const std::size_t now = in_use += malloc_usable_size(p);
  if (now > most_in_use) most_in_use = now;
  return p;
}
void uncount(void* p) {
  if (p != nullptr) in_use -= malloc_usable_size(p);
}
}  // namespace

// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp,readability-identifier-naming)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* p, std::size_t size);
void __libc_free(void* p);

void* malloc(std::size_t size) noexcept { return counted(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) noexcept {
  return counted(__libc_calloc(count, size));
}
void* realloc(void* p, std::size_t size) noexcept {
  uncount(p);
  return counted(__libc_realloc(p, size));
}
void free(void* p) noexcept {
  uncount(p);
  __libc_free(p);
}
}
// NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp,readability-identifier-naming)

namespace volcomp::bench {
namespace {

using namespace host::identify;
namespace fs = std::filesystem;

constexpr double kNoGoal = 0.0;

double processor_s() {
  timespec now{};
  static_cast<void>(::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now));
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Times of one piece of work, s.
class Times {
 public:
  template <class Work>
  void add(const Work& work) {
    const double begin = processor_s();
    work();
    s_.push_back(processor_s() - begin);
  }
  // Each repetition of several pieces together.
  void add_to(Times& sum) const {
    if (sum.s_.empty()) sum.s_.assign(s_.size(), 0.0);
    for (std::size_t i = 0; i < s_.size(); ++i)
      sum.s_[i] += s_[i];
  }
  // A row of the table; whether the goal is met.
  [[nodiscard]] bool print(const char* what, double goal_s) const {
    const auto [least, most] = std::minmax_element(s_.begin(), s_.end());
    const double middle = median(s_);
    fmt::print("| {} | {:.3f} | {:.3f} … {:.3f} | {} |\n", what, middle, *least, *most,
               goal_s > kNoGoal ? fmt::format("{:g}", goal_s) : "");
    return goal_s <= kNoGoal || middle < goal_s;
  }

 private:
  std::vector<double> s_;
};

// The plan of a folder of its own, beside its machine, with positions alone.
MeasurementPlan planned(const fs::path& path) {
  std::ifstream in(path);
  if (!in) {
    fmt::print(stderr, "{}: cannot be opened\n", path.string());
    std::exit(2);
  }
  // Readings come later, and balls have a radius that the plan need not state.
  const fs::path folder =
      fs::temp_directory_path() / ("volcomp_identification_bench." + std::to_string(getpid()));
  fs::create_directory(folder);
  fs::copy_file(host::bundled_machine("xyfz"), folder / "xyfz.toml",
                fs::copy_options::overwrite_existing);
  std::ofstream out(folder / "plan.toml");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("file = \"touches", 0) == 0) continue;
    out << line << '\n';
    if (line.rfind("calibrated = true", 0) == 0) out << "radius_mm = 10\n";
  }
  out.close();
  MeasurementPlan plan = read_plan(folder / "plan.toml");
  fs::remove_all(folder);
  return plan;
}

// Readings of a machine with errors of some 10 µm and 20 µrad, with the noise that is stated.
void measure(Problem& problem) {
  constexpr double kError_mm = 10e-3;
  constexpr double kError_rad = 20e-6;
  std::mt19937_64 random(20261128);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::normal_distribution<double> noise;
  const Equations equations(problem, true);
  Estimate truth = equations.start();
  for (Index i = 0; i < equations.unknowns().of_machine(); ++i)
    truth.x(i) = any(random) * (equations.unknowns().is_angle(i) ? kError_rad : kError_mm);
  std::vector<std::vector<double>> y(problem.setups.size());
  equations.visit_readings(
      truth, [&](const ReadingPlace& at, const VectorXd& /*row*/, double residual) {
        const double sigma = problem.setups[at.setup].sigma[y[at.setup].size()];
        y[at.setup].push_back(sigma * (noise(random) - residual));
      });
  for (std::size_t k = 0; k < y.size(); ++k)
    problem.setups[k].y = y[k];
}

// Four tracers outside the corners, one of them high, each with its own tip, anywhere in the
// travels.
Problem tracers(const MeasurementPlan& plate, std::size_t readings) {
  Problem problem = plate.problem;
  problem.setups.clear();
  problem.artefacts.clear();
  problem.model.functions[plate.machine.axis_index('X')].segments = 16;
  problem.model.functions[plate.machine.axis_index('Y')].segments = 11;
  problem.model.functions[plate.machine.axis_index('Z')].segments = 13;
  const std::array<Vec3, 4> stations{Vec3(-500.0, -400.0, 50.0), Vec3(500.0, -400.0, 100.0),
                                     Vec3(500.0, 700.0, 50.0), Vec3(-400.0, 600.0, 1100.0)};
  std::mt19937_64 random(1);
  for (std::size_t k = 0; k < stations.size(); ++k) {
    SetUp s;
    s.name = fmt::format("T{}", k);
    s.kind = ObservationKind::tracer;
    s.station = stations.at(k);
    s.scale = 0.15e-6;
    for (std::size_t i = 0; i < readings / stations.size(); ++i) {
      Pose q{};
      for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
        const auto& travel = problem.machine.travel.at(a);
        q.at(a) = std::uniform_real_distribution<double>(travel.lo, travel.hi)(random);
      }
      s.q.push_back(q);
    }
    s.d.assign(s.q.size(), Directions{});
    s.stylus.assign(s.q.size(), k % problem.styli.size());
    s.sigma.assign(s.q.size(), std::hypot(0.1e-3, 0.7e-3));
    problem.setups.push_back(std::move(s));
  }
  measure(problem);
  return problem;
}

void require_solved(const Solution& solution) {
  if (solution.converged && solution.chi2 < 2.0 * static_cast<double>(solution.dof)) return;
  fmt::print(stderr, "not solved: {} steps, chi-square {} of {}\n", solution.steps, solution.chi2,
             solution.dof);
  std::exit(2);
}

bool plate_row(const Problem& problem, std::size_t repetitions) {
  constexpr double kGoal_s = 1.0;
  constexpr double kLeaveOutGoal_s = 5.0;
  constexpr std::size_t kPlaces = 1500;
  const Equations equations(problem, true);
  std::optional<Solution> solution;
  Times solved, ranked, covariance, volume, all, left_out;
  for (std::size_t n = 0; n < repetitions; ++n) {
    solved.add([&] { solution = solve(equations, false); });
    ranked.add([&] { static_cast<void>(rank_of(problem)); });
    covariance.add([&] {
      const Index size = equations.unknowns().size();
      MatrixXd inverse = MatrixXd::Identity(size, size);
      solution->triangle.R().triangularView<Eigen::Upper>().solveInPlace(inverse);
      const MatrixXd C = inverse * inverse.transpose();
      if (!C.allFinite()) std::exit(2);
    });
    volume.add([&] {
      static_cast<void>(volume_uncertainty(equations, solution->triangle,
                                           places_of(problem.machine, kPlaces),
                                           problem.machine.chain.tool_point()));
    });
    left_out.add([&] {
      for (const SetUpCheck& check : check_consistency(equations, *solution).setups)
        if (!check.left_out) std::exit(2);
    });
  }
  require_solved(*solution);
  fmt::print("| ball plate, {} unknowns, {} rows | | | |\n", equations.unknowns().size(),
             solution->triangle.rows());
  static_cast<void>(
      solved.print(fmt::format("– solved in {} steps", solution->steps).c_str(), kNoGoal));
  static_cast<void>(ranked.print("– rank", kNoGoal));
  static_cast<void>(covariance.print("– covariance", kNoGoal));
  static_cast<void>(volume.print("– uncertainty at 1500 places", kNoGoal));
  for (const Times* part : {&solved, &ranked, &covariance, &volume})
    part->add_to(all);
  bool good = all.print("**all of these**", kGoal_s);
  return left_out.print(fmt::format("**leaving out {} set-ups**", problem.setups.size()).c_str(),
                        kLeaveOutGoal_s) &&
         good;
}

bool many_readings(const MeasurementPlan& plate, std::size_t repetitions) {
  constexpr double kGoal_s = 3.0;
  constexpr std::size_t kReadings = 20'000;
  const Problem problem = tracers(plate, kReadings);
  const Equations equations(problem, true);
  std::optional<Solution> solution;
  Times solved;
  for (std::size_t n = 0; n < repetitions; ++n)
    solved.add([&] { solution = solve(equations, false); });
  require_solved(*solution);
  return solved.print(
      fmt::format("**tracers, {} unknowns, {} rows**, solved in {} steps",
                  equations.unknowns().size(), solution->triangle.rows(), solution->steps)
          .c_str(),
      kGoal_s);
}

// Peak of memory of an estimate beyond what its problem takes, in squares of the unknowns of
// doubles.
bool memory_rows(const MeasurementPlan& plate) {
  constexpr double kSame = 1.25;  // room that blocks of Eigen take
  fmt::print("\n| readings | peak of an estimate, MB | over unknowns squared x 8 bytes |\n");
  fmt::print("|---|---:|---:|\n");
  double first = 0.0;
  bool good = true;
  for (const std::size_t readings : {5'000U, 10'000U, 20'000U}) {
    const Problem problem = tracers(plate, readings);
    const Equations equations(problem, true);
    const std::size_t before = in_use;
    most_in_use = before;
    require_solved(solve(equations, false));
    const auto peak = static_cast<double>(most_in_use - before);
    const auto unknowns = static_cast<double>(equations.unknowns().size());
    fmt::print("| {} | {:.2f} | {:.1f} |\n", readings, 1e-6 * peak,
               peak / (8.0 * unknowns * unknowns));
    if (first <= 0.0) first = peak;
    good = good && peak < kSame * first;
  }
  return good;
}

bool run(const fs::path& path, std::size_t repetitions, bool goals) {
  MeasurementPlan plan = planned(path);
  measure(plan.problem);
  fmt::print("{} repetitions\n\n", repetitions);
  fmt::print("| processor time, s | median | least … most | goal |\n|---|---:|---:|---:|\n");
  bool in_time = plate_row(plan.problem, repetitions);
  in_time = many_readings(plan, repetitions) && in_time;
  return memory_rows(plan) && (in_time || !goals);
}

}  // namespace
}  // namespace volcomp::bench

int main(int argc, char** argv) {
  CLI::App app{"What identification of a machine's errors costs on this computer."};
  std::filesystem::path plan;
  std::size_t repetitions = 5;
  bool goals = false;
  app.add_option("PLAN", plan, "tests/data/plan_plate.toml")->required();
  app.add_option("--repetitions", repetitions, "of which the median is printed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_flag("--goals", goals, "end with 1 where a time is over its goal");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return volcomp::bench::run(plan, repetitions, goals) ? EXIT_SUCCESS : EXIT_FAILURE;
}
