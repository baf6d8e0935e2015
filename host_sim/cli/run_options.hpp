#pragma once
// What the scenarios of volcomp run have in common: where the node is, where the figures go.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "host_sim/cli/output.hpp"
#include "host_sim/cli/run_view.hpp"
#include "host_sim/cli/scenario_bus.hpp"

namespace volcomp::cli {

struct RunArguments {
  std::string machine;        // empty: the one that comes with the program
  std::string json_file;      // empty: none
  std::string report_folder;  // empty: none
  std::string command;        // as the user has typed it
  NodePlace node;
  LiveChoice live;
};

// File and path as the user would type them, without the folder of the program.
[[nodiscard]] std::string command_line(int argc, char** argv);

// Machine file, figures, live view and report; returns --report.
CLI::Option* add_output_options(CLI::App& scenario, RunArguments& arguments);
// --can; where `node` is not integrated, its bus is the default.
void add_can_option(CLI::App& scenario, NodePlace& node);
// --drive-profile: only for a node on a bus.
CLI::Option* add_drive_option(CLI::App& scenario, NodePlace& node);
// Cycle and log: only for a node on a bus.
std::vector<CLI::Option*> add_bus_options(CLI::App& scenario, NodePlace& node);
// Throws CLI::RequiresError for one of these options without a node; `place`: the options that
// choose one.
void require_node(const std::vector<CLI::Option*>& options, const NodePlace& node,
                  const std::string& place);
void add_seed(CLI::App& scenario, const std::string& name, std::uint64_t& seed,
              const std::string& what);

[[nodiscard]] std::filesystem::path machine_of(const RunArguments& arguments,
                                               const std::string& bundled);

// Refuses an option that writes or shows pages in a program that was built without them.
void require_page(const std::string& option);

// The page of a report in its folder.
[[nodiscard]] std::string report_page(const std::filesystem::path& folder);
// `names` and those of a report, if a folder for one is given; refused without require_page().
[[nodiscard]] std::vector<std::string> with_report(std::vector<std::string> names,
                                                   const std::string& folder);
void add_report(Results& results, const std::string& folder, const nlohmann::json& document);

// An option that takes one of these words; the help text shows that of `value` as its default.
template <class Choice>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Choice& value,
                        const std::map<std::string, Choice>& words, const std::string& what) {
  std::string list;
  std::string usual;
  for (const auto& [word, choice] : words) {
    list += (list.empty() ? "" : ",") + word;
    if (choice == value) usual = word;
  }
  // As CLI::IsMember describes itself.
  return app.add_option(name, value, what)
      ->transform(CLI::Transformer(words, CLI::ignore_case).description("{" + list + "}"))
      ->type_name("ENUM")  // also where two words stand for yes and no
      ->default_str(usual);
}

}  // namespace volcomp::cli
