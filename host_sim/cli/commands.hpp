#pragma once
// The subcommands of the host tool. Each registers itself and sets `code` when it ran.

#include <string>

#include <CLI/CLI.hpp>

namespace volcomp::cli {

void add_run_command(CLI::App& app, int argc, char** argv, int& code);
// Below "run"; `command` as the user has typed it.
void add_face_gear_command(CLI::App& run, const std::string& command, int& code);
void add_internal_helical_command(CLI::App& run, const std::string& command, int& code);
void add_l300g_command(CLI::App& run, const std::string& command, int& code);
void add_reversal_command(CLI::App& run, const std::string& command, int& code);
void add_run_machine_command(CLI::App& run, const std::string& command, int& code);
void add_self_calibration_command(CLI::App& run, const std::string& command, int& code);
void add_xyfz_command(CLI::App& run, const std::string& command, int& code);
void add_build_tables_command(CLI::App& app, int& code);
void add_export_tables_command(CLI::App& app, int& code);
void add_import_command(CLI::App& app, int& code);
void add_drive_command(CLI::App& app, int& code);
void add_dump_command(CLI::App& app, int& code);
void add_evaluate_command(CLI::App& app, int& code);
void add_evaluate_ballbar_command(CLI::App& app, int argc, char** argv, int& code);
void add_calibrate_probe_command(CLI::App& app, int& code);
void add_inspect_command(CLI::App& app, int& code);
void add_collect_command(CLI::App& app, int& code);
void add_check_lever_command(CLI::App& app, int& code);
void add_learn_command(CLI::App& app, int argc, char** argv, int& code);
void add_machine_command(CLI::App& app, int& code);
void add_list_command(CLI::App& app, int& code);
void add_device_files_command(CLI::App& app, int& code);
void add_explain_command(CLI::App& app, int& code);
void add_can_commands(CLI::App& app, int& code);
void add_setup_command(CLI::App& app, int& code);
void add_replay_command(CLI::App& app, int& code);
void add_bus_load_command(CLI::App& app, int& code);
void add_compare_command(CLI::App& app, int argc, char** argv, int& code);
void add_completion_command(CLI::App& app, int& code);
void add_man_command(CLI::App& app, int& code);
void add_monitor_command(CLI::App& app, int& code);
void add_simulate_command(CLI::App& app, int& code);
void add_identify_command(CLI::App& app, int argc, char** argv, int& code);
void add_plan_command(CLI::App& app, int argc, char** argv, int& code);
void add_uncertainty_command(CLI::App& app, int argc, char** argv, int& code);
void add_verify_command(CLI::App& app, int argc, char** argv, int& code);

}  // namespace volcomp::cli
