// volcomp bus-load

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/bus_load.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::cli {
namespace {

struct BusLoadArguments {
  std::size_t axes = 0;
  std::vector<unsigned> ways;
  bool unconfirmed = false;
  std::string json_file;
};

constexpr std::size_t kMostAxes = 8;

// One way is that of all axes.
std::vector<host::CycleAxes> machines_of(const BusLoadArguments& arguments) {
  std::vector<std::size_t> counts{3, 5};
  if (arguments.axes != 0) counts = {arguments.axes};
  if (arguments.ways.size() > 1) {
    if (arguments.axes != 0 && arguments.axes != arguments.ways.size())
      throw host::UserError(fmt::format("--way has the ways of {} axes, --axes is {}",
                                        arguments.ways.size(), arguments.axes));
    counts = {arguments.ways.size()};
  }
  std::vector<host::CycleAxes> machines;
  for (const std::size_t count : counts) {
    host::CycleAxes axes(count);
    for (std::size_t a = 0; a < count; ++a) {
      axes[a].confirmed = !arguments.unconfirmed;
      if (!arguments.ways.empty())
        axes[a].way = static_cast<node::Way>(arguments.ways.size() == 1 ? arguments.ways.front()
                                                                        : arguments.ways[a]);
    }
    machines.push_back(axes);
  }
  return machines;
}

int print_bus_load(const BusLoadArguments& arguments) {
  Results results({arguments.json_file});
  const nlohmann::json document = host::bus_load_document(machines_of(arguments));
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
      ->check(CLI::Range(std::size_t{1}, kMostAxes));
  command
      ->add_option("--way", a->ways,
                   "How corrections reach the axes, one for all or W,W,... for each: 0 by 60B0h, 1 "
                   "in the target that the node forwards, 3 the controller adds it, 4 not at all")
      ->delimiter(',')
      ->check(CLI::IsMember({0U, 1U, 3U, 4U}))
      ->expected(1, static_cast<int>(kMostAxes));
  command->add_flag("--unconfirmed", a->unconfirmed,
                    "Drives of way 0 do not report their offset: without 480h + n");
  command->add_option("--json", a->json_file,
                      "Write the table to this file, too (-: standard output)");
  command->callback([a, &code] { code = print_bus_load(*a); });
}

}  // namespace volcomp::cli
