// volcomp simulate observations

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/output.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/cli/simulate_options.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"
#include "host_sim/sim/campaign/simulated_readings.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"

namespace volcomp::cli {
namespace {

struct ObservationArguments {
  std::string plan;
  std::string out;
  std::uint64_t machine_seed = 1;
  sim::ShopFloor floor;
};

int simulate_observations(const ObservationArguments& a) {
  const host::identify::MeasurementPlan plan = host::identify::read_plan(a.plan, {{}, true});
  std::vector<std::string> inputs{a.plan, plan.machine.path};
  for (const auto& file : plan.files)
    inputs.push_back(file.string());
  Results results({}, inputs, a.out);
  const sim::TrueMachine truth = sim::draw_machine(plan.machine, a.machine_seed);
  std::vector<host::NamedText> files;
  std::string text;
  for (const auto& [name, table] :
       sim::simulate_plan(plan, sim::draw_plan_truth(plan.problem, truth, a.floor))) {
    files.push_back({name, table});
    text += (std::filesystem::path(a.out) / name).string() + '\n';
  }
  for (const std::string& sphere : plan.unreached)
    text += "out of reach, left out: " + sphere + '\n';
  results.add_files(a.out, files);
  results.write();
  fmt::print(results.text(), "{}", text);
  return 0;
}

}  // namespace

void add_simulate_observations_command(CLI::App& simulate, int& code) {
  CLI::App* command = simulate.add_subcommand(
      "observations",
      "The tables of a measurement plan, of every kind of set-up, for identify: errors of the "
      "machine, artefact, instruments and temperature drawn at random");
  auto a = std::make_shared<ObservationArguments>();
  command->add_option("PLAN", a->plan, "Measurement plan (TOML)")->required();
  command->add_option("--out", a->out, "Folder for the files the plan names")->required();
  add_seed(*command, "--machine-seed", a->machine_seed, "Seed of the errors of the machine");
  add_seed(*command, "--seed", a->floor.seed, "Seed of instruments, artefacts and readings");
  command->add_flag("--perfect", a->floor.perfect, "Instruments and artefacts without errors");
  command->callback([a, &code] { code = simulate_observations(*a); });
}

}  // namespace volcomp::cli
