// volcomp bus-load

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/experiments/xyfz/bus_load_measured.hpp"

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
  const std::vector<host::BusLoadRow> table = host::bus_load_table(axes, xyfz::measure_bus_load);
  results.add(arguments.json_file, json_text(host::to_json(table)));
  results.write();
  fmt::print(results.text(), "{}", host::describe(table));
  return 0;
}

}  // namespace

void add_bus_load_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "bus-load", "How much of a CAN bus the compensation takes, computed and measured");
  auto a = std::make_shared<BusLoadArguments>();
  command->add_option("--axes", a->axes, "This number of axes only (default: 3 and 5)")
      ->check(CLI::Range(1, 8));
  command->add_option("--json", a->json_file,
                      "Write the table to this file, too (-: standard output)");
  command->callback([a, &code] { code = print_bus_load(*a); });
}

}  // namespace volcomp::cli
