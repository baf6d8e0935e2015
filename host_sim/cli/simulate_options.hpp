#pragma once
// What the commands below `volcomp simulate` have in common: which machine, which instruments.

#include <cstdint>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "host_sim/cli/scenario_bus.hpp"
#include "host_sim/experiments/xyfz/scenario.hpp"
#include "host_sim/sim/campaign/simulated_measurement.hpp"
#include "host_sim/sim/instruments/circular_ball_bar.hpp"

namespace volcomp::cli {

struct SimulateArguments {
  std::string machine;  // empty: the one that comes with the program
  std::uint64_t machine_seed = xyfz::kXyfzMachineSeed;
  sim::Instruments instruments;
  std::size_t runs = 5;
  sim::DiagonalPlan plan;
  int volume_points = 100;
  std::string plane = "XY";
  sim::CirclePlan circles;
  std::string out;
  std::string json_file;
  std::string tables;
  NodePlace node;
};

// With the errors of the paper's machine where the file describes one like it. Throws UserError.
[[nodiscard]] sim::SimulatedMachine machine_of(const SimulateArguments& a);

[[nodiscard]] std::shared_ptr<SimulateArguments> add_machine_options(CLI::App& command);
void add_perfect(CLI::App& command, sim::Instruments& instruments);

// --- simulate_ball_bar_command.cpp
void add_simulate_ball_bar_command(CLI::App& simulate, int& code);
// --- simulate_observations_command.cpp
void add_simulate_observations_command(CLI::App& simulate, int& code);

}  // namespace volcomp::cli
