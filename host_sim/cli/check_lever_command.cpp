// volcomp check-lever

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/commissioning/lever_check.hpp"

namespace volcomp::sim {
namespace {

struct LeverArguments {
  std::string machine;
  std::string first;
  std::string second;
  std::vector<double> second_point;
};

std::string point_text(const Vec3& p) {
  return fmt::format("{:.3f} {:.3f} {:.3f} mm", p(0), p(1), p(2));
}

int check(const LeverArguments& a) {
  const LeverVerdict v =
      check_lever(read_machine_file(a.machine), read_runs_file(a.first), read_runs_file(a.second),
                  Vec3(a.second_point.at(0), a.second_point.at(1), a.second_point.at(2)));
  fmt::print("axis {}, {} targets, measured at {} and at {}\n", v.axis, v.targets,
             point_text(v.first_point), point_text(v.second_point));
  for (const LeverAngle& angle : v.angle) {
    fmt::print("{}: lever {:.1f} mm expected, {:.1f} found, {:.1f} allowed: {}{}\n", angle.channel,
               angle.expected_mm, angle.found_mm, angle.allowed_mm, angle.good ? "good" : "wrong",
               angle.hint.empty() ? "" : ", " + angle.hint);
  }
  fmt::print(v.good() ? "PASS signs, units and order of the angles fit the levers\n"
                      : "FAIL the positioning at the two places does not differ as angles and "
                        "levers say\n");
  return v.good() ? 0 : 1;
}

}  // namespace

void add_check_lever_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand("check-lever",
                                         "Hold runs of one linear axis at two places against each "
                                         "other: do the angles fit the levers?");
  auto a = std::make_shared<LeverArguments>();
  command->add_option("--machine", a->machine, "Machine file (TOML)")->required();
  command->add_option("--first", a->first, "Runs (CSV) at the sensed point of the machine file")
      ->required();
  command->add_option("--second", a->second, "Runs (CSV) of the same axis and targets elsewhere")
      ->required();
  command
      ->add_option("--second-point", a->second_point,
                   "Reading head to sensed point of the second runs at machine zero, X Y Z in mm")
      ->required()
      ->expected(3)
      ->check(CLI::Range(-1e5, 1e5));
  command->callback([a, &code] { code = check(*a); });
}

}  // namespace volcomp::sim
