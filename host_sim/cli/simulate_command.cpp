// volcomp simulate: the simulated machine measured, for trying the tools without one.

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/cli/run_files.hpp"
#include "host_sim/cli/simulate_options.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/xyz_axes.hpp"
#include "host_sim/sim/campaign/simulated_measurement.hpp"

namespace volcomp::cli {
namespace {

int simulate_run_files(const SimulateArguments& a) {
  Results results({a.json_file}, {a.machine}, a.out);
  const sim::SimulatedMachine simulated = machine_of(a);
  std::vector<host::NamedText> files;
  std::string text;
  nlohmann::json axes = nlohmann::json::array();
  for (const host::RunsFile& runs : sim::simulate_runs(simulated, a.instruments, a.runs)) {
    const std::string path = (std::filesystem::path(a.out) / runs.name).string();
    files.push_back({runs.name, host::runs_csv(runs)});
    text += path + "\n";
    axes.push_back(run_file_json(runs, path));
  }
  results.add_files(a.out, files);
  const nlohmann::json figures{{"machine", simulated.machine.path},
                               {"machine_seed", a.machine_seed},
                               {"seed", a.instruments.seed},
                               {"perfect", a.instruments.perfect},
                               {"folder", a.out},
                               {"values", run_values_json()},
                               {"axes", axes}};
  results.add(a.json_file, json_text(figures));
  results.write();
  fmt::print(results.text(), "{}", text);
  return 0;
}

// What the node on the bus was found to do.
std::string node_words(const sim::BusAxes& axes) {
  const std::uint8_t id = axes.controller().settings().node;
  const std::uint32_t crc = axes.controller().report().active_crc;
  if (crc == 0) return fmt::format("node {} has no tables: nothing is compensated", id);
  return fmt::format("node {} compensates with its tables, CRC-32 {:08X}", id, crc);
}

// Runs `measure(cell, progress)` on the machine with the chosen compensation; `words` names it.
template <class Measure>
auto on_machine(const SimulateArguments& a, const sim::SimulatedMachine& simulated,
                const Measure& measure, std::string& words) {
  std::unique_ptr<ScenarioBus> bus;
  if (!a.node.can.empty()) bus = std::make_unique<ScenarioBus>(a.node);
  return run_with_bar(bus.get(), [&](const host::Progress& progress) {
    progress(0.0, "starting the machine");
    const host::MachineFile& machine = simulated.machine;
    std::unique_ptr<sim::MotionCell> cell;
    const sim::BusAxes* axes = nullptr;
    if (bus) {
      host::BusSettings settings = host::bus_settings(machine, a.node.cycle_hz);
      settings.node_brings_tables = true;
      auto on_bus = bus->axes()(settings, {});
      axes = on_bus.get();
      cell = std::make_unique<sim::MotionCell>(simulated.truth, std::move(on_bus));
    } else {
      const auto image =
          a.tables.empty() ? std::vector<std::uint8_t>() : host::read_image_file(a.tables);
      cell = sim::make_integrated_cell(simulated.truth, machine.correction, image);
    }
    const host::XyzAxes xyz(machine);
    cell->place(xyz.pose(xyz.travel().lo));
    words = axes != nullptr    ? node_words(*axes)
            : a.tables.empty() ? "nothing is compensated"
                               : "compensated with " + a.tables;
    auto measured = measure(*cell, progress);
    cell.reset();
    if (bus) bus->switch_off();
    return measured;
  });
}

void check(const SimulateArguments& a) {
  if (a.node.can == "loopback")
    throw host::UserError("loopback is a bus inside volcomp run; there is no node to be met on it");
}

// Writes what `csv` makes of the measurement and prints its extent as `extent` names it.
template <class Measure, class Csv, class Extent>
int simulate_file(const SimulateArguments& a, const Measure& measure, const Csv& csv,
                  const Extent& extent) {
  check(a);
  Results results({a.out, a.node.log_file}, {a.machine, a.tables});
  const sim::SimulatedMachine simulated = machine_of(a);
  std::string words;
  const auto file = on_machine(
      a, simulated,
      [&](sim::MotionCell& cell, const host::Progress& progress) {
        return measure(cell, simulated.machine, progress);
      },
      words);
  results.add(a.out, csv(file));
  results.write();
  fmt::print(results.text(), "{}\n{}: {}\n", words, shown_output(a.out), extent(file));
  return 0;
}

int simulate_diagonal_file(const SimulateArguments& a) {
  return simulate_file(
      a,
      [&](sim::MotionCell& cell, const host::MachineFile& machine, const host::Progress& progress) {
        return sim::simulate_diagonals(cell, machine, a.plan, a.instruments, progress);
      },
      host::diagonals_csv,
      [&](const host::DiagonalsFile& file) {
        return fmt::format("{} diagonals, {} targets, {} runs up and down", file.diagonals.size(),
                           a.plan.points, a.plan.runs);
      });
}

int simulate_volume_file(const SimulateArguments& a) {
  return simulate_file(
      a,
      [&](sim::MotionCell& cell, const host::MachineFile& machine, const host::Progress& progress) {
        progress(0.0, "places of the volume");
        return sim::simulate_volume(cell, machine, a.volume_points, a.instruments.seed);
      },
      host::volume_csv,
      [](const host::VolumeFile& file) { return fmt::format("{} places", file.points.size()); });
}

void add_compensation_options(CLI::App& command, SimulateArguments& a) {
  CLI::Option* can = command.add_option(
      "--can", a.node.can,
      fmt::format("Drives and controller of the machine on this bus, compensated by the node there "
                  "with the tables it has: {}",
                  host::kLinkForms));
  command
      .add_option("--tables", a.tables,
                  "Image file to compensate with, without a bus (default: no compensation)")
      ->excludes(can);
  for (CLI::Option* option : add_bus_options(command, a.node))
    option->needs(can);
}

}  // namespace

void add_simulate_command(CLI::App& app, int& code) {
  CLI::App* simulate = app.add_subcommand(
      "simulate", "Measure a simulated machine: the CSV files its owner would have");
  simulate->require_subcommand(1);

  CLI::App* runs = simulate->add_subcommand("runs", "Runs of every axis, for build-tables");
  const auto r = add_machine_options(*runs);
  add_perfect(*runs, r->instruments);
  runs->add_option("--runs", r->runs, "Runs in each direction")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  runs->add_option("--out", r->out, "Folder for runs_X.csv and one of every other axis")
      ->required();
  runs->add_option("--json", r->json_file,
                   "Write what was measured and written to this file (-: standard output)");
  runs->callback([r, &code] { code = simulate_run_files(*r); });

  CLI::App* diagonals =
      simulate->add_subcommand("diagonals", "Body diagonals after ISO 230-6, for verify");
  const auto d = add_machine_options(*diagonals);
  add_perfect(*diagonals, d->instruments);
  diagonals->add_flag("--faces", d->plan.faces, "The six diagonals of the faces, too");
  diagonals->add_option("--points", d->plan.points, "Targets of a diagonal")
      ->check(CLI::Range(2, 512))
      ->capture_default_str();
  diagonals->add_option("--runs", d->plan.runs, "Runs in each direction")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  diagonals->add_option("--out", d->out, "CSV file to write (-: standard output)")->required();
  add_compensation_options(*diagonals, *d);
  diagonals->callback([d, &code] { code = simulate_diagonal_file(*d); });

  add_simulate_ball_bar_command(*simulate, code);
  add_simulate_observations_command(*simulate, code);

  CLI::App* volume =
      simulate->add_subcommand("volume", "Error vectors at random places, for verify --volume");
  const auto v = add_machine_options(*volume);
  volume->add_option("--points", v->volume_points, "Places")
      ->check(CLI::Range(4, 100000))
      ->capture_default_str();
  volume->add_option("--out", v->out, "CSV file to write (-: standard output)")->required();
  add_compensation_options(*volume, *v);
  volume->callback([v, &code] { code = simulate_volume_file(*v); });
}

}  // namespace volcomp::cli
