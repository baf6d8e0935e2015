#include "host_sim/cli/drive_forward.hpp"

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/drive_bus.hpp"
#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/drive_check/drive_route.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

struct ForwardArguments {
  DriveBusOptions bus;
  int drive = 1;
  int way = 0;
  bool way_given = false;
  bool off = false;
  bool store = false;
  bool yes = false;
  std::string json_file;
};

host::DriveRoute route_of(const ForwardArguments& a) {
  if (a.off) return host::DriveRoute::direct;
  return a.way == 1 ? host::DriveRoute::forwarded : host::DriveRoute::offset;
}

std::string question_of(const ForwardArguments& a, const std::vector<host::PdoPlan>& plan) {
  std::string text =
      fmt::format("The node must not be OPERATIONAL. Node {} gets these PDOs{}:", a.drive,
                  a.store ? ", and stores all it holds (1010h)" : " until it is switched off");
  for (const host::PdoPlan& one : plan)
    text += "\n  " + host::describe(one);
  return text;
}

nlohmann::json json_of(const ForwardArguments& a, const std::vector<host::PdoPlan>& done) {
  nlohmann::json pdos = nlohmann::json::array();
  for (const host::PdoPlan& one : done)
    pdos.push_back(host::describe(one));
  return {{"node", a.drive},
          {"way", a.off ? nlohmann::json() : nlohmann::json(a.way)},
          {"pdos", pdos},
          {"stored", a.store}};
}

// The order of the whole: node out of OPERATIONAL, drive, 2034h, 2037h.
int forward(const ForwardArguments& a) {
  Results results({a.json_file});
  if (a.off == a.way_given)
    throw host::UserError("drive forward needs --way or --off, one of them");
  DriveBus bus(a.bus);
  host::NodeClient client = bus.client_of(static_cast<std::uint8_t>(a.drive));
  const host::ForeignDrive drive = read_with_bar(client);
  bus.require_ready(client, drive);
  const std::vector<host::PdoPlan> plan = host::plan_of(drive, route_of(a));
  require_consent(question_of(a, plan), a.yes);
  std::vector<host::PdoPlan> done;
  bus.change(client,
             [&](host::DriveChanges& changes) { done = host::set_route(changes, drive, plan); });
  if (a.store) host::store_in_drive(client);
  // Here the node is told: 2034h (way of the axis), then 2037h (the mapping that was read back).
  results.add(a.json_file, json_text(json_of(a, done)));
  results.write();
  for (const host::PdoPlan& one : done)
    fmt::print(results.text(), "{}\n", host::describe(one));
  return number(ExitCode::done);
}

}  // namespace

void add_drive_forward(CLI::App& drive, int& code) {
  CLI::App* command = drive.add_subcommand(
      "forward", "Set up the PDOs of a drive for a way of the node, or for a machine without it");
  auto a = std::make_shared<ForwardArguments>();
  command->add_option("--can", a->bus.link, fmt::format("The bus: {}", host::kLinkForms))
      ->required();
  command->add_option("--node", a->drive, "CANopen node id of the drive")
      ->check(CLI::Range(1, 127))
      ->required();
  CLI::Option* const way = command->add_option(
      "--way", a->way,
      "0: the offset 60B0h comes from the node; 1: the target 607Ah comes from the node");
  way->check(CLI::Range(0, 1));
  command->add_flag("--off", a->off, "Without the node: 6040h and 607Ah from the controller");
  command->add_flag("--store", a->store, "The drive stores its parameters afterwards (1010h)");
  command->add_flag("--yes", a->yes, "Do not ask");
  command->add_option("--timeout", a->bus.timeout_ms, "For each answer of the drive, ms")
      ->check(number_between(1.0, 60'000.0))
      ->capture_default_str();
  add_journal_option(*command, a->bus.journal);
  command->add_option("--json", a->json_file,
                      "Write what each PDO became to this file (-: standard output)");
  command->callback([a, way, &code] {
    a->way_given = way->count() > 0;
    code = forward(*a);
  });
}

}  // namespace volcomp::cli
