// volcomp check-lever

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/tables/lever_check.hpp"

namespace volcomp::cli {
namespace {

struct LeverArguments {
  std::string machine;
  std::string first;
  std::string second;
  std::vector<double> second_point;
  std::string json_file;
};

std::string point_text(const Vec3& p) {
  return fmt::format("{:.3f} {:.3f} {:.3f} mm", p(0), p(1), p(2));
}

nlohmann::json to_json(const host::LeverVerdict& v) {
  nlohmann::json angles = nlohmann::json::array();
  for (const host::LeverAngle& angle : v.angle) {
    angles.push_back({{"channel", angle.channel},
                      {"expected_mm", angle.expected_mm},
                      {"found_mm", angle.found_mm},
                      {"allowed_mm", angle.allowed_mm},
                      {"ok", angle.good},
                      {"hint", angle.hint}});
  }
  return {{"axis", std::string(1, v.axis)},
          {"targets", v.targets},
          {"angles", angles},
          {"ok", v.good()}};
}

int check(const LeverArguments& a) {
  Results results({a.json_file}, {a.machine, a.first, a.second});
  std::FILE* const words = results.text();
  const host::LeverVerdict v =
      host::check_lever(host::read_machine_file(a.machine), host::read_runs_file(a.first),
                        host::read_runs_file(a.second),
                        Vec3(a.second_point.at(0), a.second_point.at(1), a.second_point.at(2)));
  results.add(a.json_file, json_text(to_json(v)));
  results.write();
  fmt::print(words, "axis {}, {} targets, measured at {} and at {}\n", v.axis, v.targets,
             point_text(v.first_point), point_text(v.second_point));
  for (const host::LeverAngle& angle : v.angle) {
    fmt::print(words, "{}: lever {:.1f} mm expected, {:.1f} found, {:.1f} allowed: {}{}\n",
               angle.channel, angle.expected_mm, angle.found_mm, angle.allowed_mm,
               angle.good ? "good" : "wrong", angle.hint.empty() ? "" : ", " + angle.hint);
  }
  fmt::print(words, "{}",
             v.good() ? "PASS signs, units and order of the angles fit the levers\n"
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
      ->check(number_between(-1e5, 1e5));
  command->add_option("--json", a->json_file, "Write it to this file, too (-: standard output)");
  command->callback([a, &code] { code = check(*a); });
}

}  // namespace volcomp::cli
