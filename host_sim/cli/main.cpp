// volcomp: the host tool. Exit codes: 0 done, 1 done but the verdict is negative, 2 input that
// cannot be used.

#include <csignal>
#include <cstdio>
#include <exception>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/data/interruption.hpp"
#include "host_sim/version.hpp"

namespace {

int run(int argc, char** argv) {
  CLI::App app{
      "Volumetric error compensation for machine tools: simulate, build tables, check machines."};
  app.name("volcomp");
  app.set_version_flag("--version", std::string("volcomp ") + volcomp::sim::kVersion);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 done but the verdict is negative, 2 input that cannot be used.");
  int code = 0;
  volcomp::sim::add_run_command(app, argc, argv, code);
  volcomp::sim::add_build_tables_command(app, code);
  volcomp::sim::add_export_tables_command(app, code);
  volcomp::sim::add_import_command(app, code);
  volcomp::sim::add_check_lever_command(app, code);
  volcomp::sim::add_machine_command(app, code);
  volcomp::sim::add_list_command(app, code);
  volcomp::sim::add_device_files_command(app, code);
  volcomp::sim::add_can_commands(app, code);
  volcomp::sim::add_replay_command(app, code);
  volcomp::sim::add_bus_load_command(app, code);
  volcomp::sim::add_compare_command(app, argc, argv, code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const volcomp::sim::Interrupted& interrupted) {
    static_cast<void>(std::raise(interrupted.signal));  // whoever waits for us shall see why
  } catch (const std::exception& e) {
    fmt::print(stderr, "volcomp: {}\n", e.what());
  } catch (...) {
    fmt::print(stderr, "volcomp: unknown error\n");
  }
  return 2;
}
