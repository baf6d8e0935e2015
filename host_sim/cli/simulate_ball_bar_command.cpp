// volcomp simulate ball-bar

#include <fmt/format.h>

#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/simulate_options.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/xyz_axes.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_csv.hpp"

namespace volcomp::cli {
namespace {

// On the machine itself, by its encoders: no controller goes round.
int simulate_ball_bar_file(const SimulateArguments& a) {
  Results results({a.out}, {a.machine});
  const sim::SimulatedMachine simulated = machine_of(a);
  const host::MachineFile& machine = simulated.machine;
  const host::XyzAxes xyz(machine);
  const DiagonalBox& travel = xyz.travel();
  sim::CirclePlan plan = a.circles;
  plan.first = static_cast<Axis>(a.plane.at(0) - 'X');
  plan.second = static_cast<Axis>(a.plane.at(1) - 'X');
  plan.centre = machine.squareness ? machine.squareness->at : Vec3(0.5 * (travel.lo + travel.hi));
  for (const Axis axis : {plan.first, plan.second}) {
    const auto k = static_cast<Eigen::Index>(axis);
    if (plan.centre(k) - plan.radius < travel.lo(k) || plan.centre(k) + plan.radius > travel.hi(k))
      throw host::UserError(
          fmt::format("the circle leaves the travel of {}: {:g} ± {:g} mm in {:g} … {:g}",
                      "XYZ"[static_cast<std::size_t>(axis)], plan.centre(k), plan.radius,
                      travel.lo(k), travel.hi(k)));
  }
  const sim::BallBarClass bar =
      a.instruments.perfect ? sim::perfect_ball_bar() : sim::BallBarClass{};
  const host::BallBarTest test = sim::measure_circles(
      simulated.truth, plan, bar, {a.instruments.seed, 0, 0},
      {machine.axis_index('X'), machine.axis_index('Y'), machine.axis_index('Z')});
  results.add(a.out, host::ball_bar_csv(test));
  results.write();
  fmt::print(results.text(), "{}: plane {}, {} circle{} each way of {} readings\n",
             shown_output(a.out), a.plane, plan.circles, plan.circles == 1 ? "" : "s",
             plan.readings);
  return 0;
}

}  // namespace

void add_simulate_ball_bar_command(CLI::App& simulate, int& code) {
  CLI::App* bar = simulate.add_subcommand(
      "ball-bar", "Circles of a ball bar in one plane, for evaluate-ballbar");
  const auto b = add_machine_options(*bar);
  bar->add_flag("--perfect", b->instruments.perfect,
                "A bar without errors (default: 0.15 µm per reading, socket 20 µm off, and more)");
  bar->add_option("--plane", b->plane, "From the first axis towards the second")
      ->check(CLI::IsMember({"XY", "YX", "YZ", "ZY", "ZX", "XZ"}))
      ->capture_default_str();
  bar->add_option("--radius-mm", b->circles.radius, "Length of the bar, mm")
      ->check(number_between(kLeastCircle, kMostCircle))
      ->capture_default_str();
  bar->add_option("--readings", b->circles.readings, "Readings of a circle")
      ->check(CLI::Range(36, 10000))
      ->capture_default_str();
  bar->add_option("--circles", b->circles.circles, "Circles each way")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  bar->add_option("--out", b->out, "CSV file to write (-: standard output)")->required();
  bar->callback([b, &code] { code = simulate_ball_bar_file(*b); });
}

}  // namespace volcomp::cli
