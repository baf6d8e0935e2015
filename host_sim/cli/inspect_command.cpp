// volcomp inspect

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/measure/gear_inspection_text.hpp"
#include "host_sim/host/measure/involute_gear_file.hpp"

namespace volcomp::cli {
namespace {

struct InspectArguments {
  std::string points;
  std::string gear;
  std::string csv_file;
  std::string json_file;
  host::InspectSettings settings;
};

int inspect(const InspectArguments& a) {
  Results results({a.csv_file, a.json_file}, {a.points, a.gear});
  const InvoluteGear gear = host::read_involute_gear(a.gear);
  const host::InspectedGear inspected =
      host::inspect_gear(gear, host::read_gear_points_file(a.points), a.settings);
  results.add(a.csv_file, host::inspection_csv(inspected));
  results.add(a.json_file, json_text(host::inspection_json(gear, inspected)));
  results.write();
  fmt::print(results.text(), "{}", host::inspection_text(gear, inspected));
  return 0;
}

}  // namespace

void add_inspect_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "inspect",
      "Grade a measured cylindrical gear by ISO 1328-1, editions of 1995 and 2013: profile, lead, "
      "pitch and run-out");
  auto a = std::make_shared<InspectArguments>();
  command
      ->add_option("POINTS", a->points,
                   "Measured gear (CSV): trace,flank,tooth and X [mm],Y [mm],Z [mm] in the frame "
                   "of the gear, or at [mm],deviation [um]")
      ->required();
  command
      ->add_option("--gear", a->gear,
                   "Gear file (TOML): teeth, module_mm, pressure_angle_deg, helix_angle_deg, "
                   "tip_diameter_mm, width_mm")
      ->required();
  command->add_flag(
      "--filter", a->settings.filter,
      "Low-pass of the edition of 2013 over each profile and lead before both editions grade it");
  command
      ->add_option("--ball-mm", a->settings.ball_mm,
                   "Run-out F_r with a ball of this diameter in every space; needs the pitch of "
                   "both sides")
      ->check(number_between(0.01, 1000.0));
  command->add_option("--csv", a->csv_file,
                      "Write deviations and grades to this file (-: standard output)");
  command->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  command->callback([a, &code] { code = inspect(*a); });
}

}  // namespace volcomp::cli
