// volcomp run SCENARIO

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/run_options.hpp"

namespace volcomp::cli {

void add_run_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* run = app.add_subcommand("run", "Run a scenario on a simulated machine");
  run->require_subcommand(1);
  const std::string command = command_line(argc, argv);
  add_xyfz_command(*run, command, code);
  add_l300g_command(*run, command, code);
  add_face_gear_command(*run, command, code);
  add_internal_helical_command(*run, command, code);
  add_reversal_command(*run, command, code);
  add_run_machine_command(*run, command, code);
  add_self_calibration_command(*run, command, code);
}

}  // namespace volcomp::cli
