// volcomp bus-load

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/bus_load.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::cli {
namespace {

struct BusLoadArguments {
  std::size_t axes = 0;
  std::string json_file;
};

int print_bus_load(const BusLoadArguments& arguments) {
  const std::vector<std::size_t> axes =
      arguments.axes == 0 ? std::vector<std::size_t>{3, 5} : std::vector{arguments.axes};
  Results results({arguments.json_file});
  const nlohmann::json document = host::bus_load_document(axes);
  results.add(arguments.json_file, json_text(host::figures_of(document)["loads"]));
  results.write();
  fmt::print(results.text(), "{}", host::text_of(document));
  return 0;
}

}  // namespace

void add_bus_load_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "bus-load", "How much of a CAN bus the compensation takes, computed from its frames");
  auto a = std::make_shared<BusLoadArguments>();
  command->add_option("--axes", a->axes, "This number of axes only (default: 3 and 5)")
      ->check(CLI::Range(1, 8));
  command->add_option("--json", a->json_file,
                      "Write the table to this file, too (-: standard output)");
  command->callback([a, &code] { code = print_bus_load(*a); });
}

}  // namespace volcomp::cli
