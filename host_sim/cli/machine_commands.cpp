// volcomp machine, volcomp list

#include <array>
#include <functional>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/bus_settings.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/machine/machine_facts.hpp"
#include "host_sim/host/machine/machine_summary.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::cli {
namespace {

struct MachineArguments {
  std::string path;
  std::string json_file;
};

using Describe = std::function<std::string(const host::MachineFile&)>;

int describe_machine(const MachineArguments& a, const Describe& describe) {
  Results results({a.json_file}, {a.path});
  const host::MachineFile machine = host::with_drives_settled(host::read_machine_file(a.path));
  const std::string text = describe(machine);
  results.add(a.json_file, json_text(host::summary_of(machine)));
  results.write();
  fmt::print(results.text(), "{}", text);
  return 0;
}

void add_description(CLI::App& machine, const std::string& name, const std::string& what,
                     const Describe& describe, int& code) {
  CLI::App* command = machine.add_subcommand(name, what);
  auto a = std::make_shared<MachineArguments>();
  command->add_option("FILE", a->path, "Machine file (TOML; -: standard input)")->required();
  command->add_option("--json", a->json_file,
                      "Write everything that follows from it to this file (-: standard output)");
  command->callback([a, describe, &code] { code = describe_machine(*a, describe); });
}

int print_example(const std::string& name) {
  constexpr std::size_t kLargest = std::size_t{1} << 20U;
  if (name.find('/') != std::string::npos)
    throw host::UserError(fmt::format("{}: not the name of a machine (volcomp list)", name));
  fmt::print("{}", host::read_whole_file(host::bundled_machine(name), kLargest));
  return 0;
}

struct Listed {
  const char* name;
  const char* what;
};
constexpr std::array<Listed, 6> kScenarios{{
    {"xyfz", "three-axis machine: laser campaign, diagonals, 21 errors"},
    {"l300g", "gear grinder that measures: involute gears, 24 errors"},
    {"face-gear", "the same for face gears, on a table and three slides"},
    {"internal-helical", "grinder of internal gears: learns the lag of its axes"},
    {"reversal", "an offset at a reversal, and the following error of the drive"},
    {"machine", "any machine file, errors at random: diagonals, volume, ball on the table"},
}};

nlohmann::json table_without_head(const std::string& title, const nlohmann::json& facts,
                                  const std::vector<const char*>& members) {
  nlohmann::json columns = nlohmann::json::array();
  for (const char* member : members)
    columns.push_back(host::plain_column(member, member));
  nlohmann::json table = host::fact_table(title, facts, std::move(columns));
  table["head"] = false;
  return table;
}

int list_everything(const std::string& json_file) {
  Results results({json_file});
  nlohmann::json facts{{"scenarios", nlohmann::json::array()},
                       {"machines", nlohmann::json::array()},
                       {"plans", nlohmann::json::array()}};
  for (const Listed& s : kScenarios)
    facts["scenarios"].push_back({{"name", s.name}, {"what", s.what}});
  for (const std::string& name : host::bundled_machines()) {
    const host::MachineFile m = host::read_machine_file(host::bundled_machine(name));
    facts["machines"].push_back(
        {{"name", name}, {"chain", host::chain_text(m.chain)}, {"file", m.path}});
  }
  for (const std::string& name : host::identify::bundled_plans())
    facts["plans"].push_back(
        {{"name", name}, {"file", host::identify::bundled_plan(name).string()}});
  results.add(json_file, json_text(facts));
  results.write();
  fmt::print(results.text(), "{}",
             host::text_of_sections(
                 {table_without_head("scenarios (volcomp run NAME):", facts["scenarios"],
                                     {"name", "what"}),
                  table_without_head("machines (volcomp machine example NAME):", facts["machines"],
                                     {"name", "chain", "file"}),
                  table_without_head("measurement plans (volcomp plan --example NAME):",
                                     facts["plans"], {"name", "file"})}));
  return 0;
}

}  // namespace

void add_machine_command(CLI::App& app, int& code) {
  CLI::App* machine = app.add_subcommand("machine", "Machine files");
  machine->require_subcommand(1);
  add_description(
      *machine, "check", "Read a machine file and say in short what it describes",
      [](const host::MachineFile& m) {
        host::require_authority(m);
        return host::short_text(m);
      },
      code);
  add_description(
      *machine, "show", "Everything that follows from a machine file",
      [](const host::MachineFile& m) { return host::summary_text(host::summary_of(m)); }, code);

  CLI::App* example = machine->add_subcommand(
      "example", "Print the file of a machine that comes with the program, to begin with");
  auto name = std::make_shared<std::string>();
  example->add_option("NAME", *name, "Its name, for instance xyfz")->required();
  example->callback([name, &code] { code = print_example(*name); });
}

void add_list_command(CLI::App& app, int& code) {
  CLI::App* list =
      app.add_subcommand("list", "List scenarios and the machines that come with the program");
  auto json_file = std::make_shared<std::string>();
  list->add_option("--json", *json_file, "Write it to this file, too (-: standard output)");
  list->callback([json_file, &code] { code = list_everything(*json_file); });
}

}  // namespace volcomp::cli
