#include "host_sim/cli/drive_forward.hpp"

#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "firmware/node/object_handles.hpp"
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
  int axis = 0;  // of the node, from 1; 0: the node is told nothing
  int node = 32;
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
  if (a.axis != 0)
    text += fmt::format("\nand then node {} gets the way of its axis {} (2034h, 2037h).", a.node,
                        a.axis);
  return text;
}

nlohmann::json json_of(const ForwardArguments& a, const std::vector<host::PdoPlan>& done) {
  nlohmann::json pdos = nlohmann::json::array();
  for (const host::PdoPlan& one : done)
    pdos.push_back(host::describe(one));
  return {{"node", a.drive},
          {"axis", a.axis != 0 ? nlohmann::json(a.axis) : nlohmann::json()},
          {"way", a.off ? nlohmann::json() : nlohmann::json(a.way)},
          {"pdos", pdos},
          {"stored", a.store}};
}

// What the user has to do next.
void tell_next(std::FILE* out, const ForwardArguments& a) {
  if (a.axis == 0) return;
  fmt::print(out, "node {}: axis {} goes way {} (2034h) until its power fails; 1010h stores it\n",
             a.node, a.axis, a.off ? 4 : a.way);
  if (a.off || a.way != 1) return;
  fmt::print(out,
             "2037h = 1 is forgotten when the drive boots or leaves OPERATIONAL: your controller "
             "reads RPDO1 and RPDO2 of the drive back and writes it at every start, when the drive "
             "is OPERATIONAL\n");
}

// The order of the whole: node out of OPERATIONAL, drive, 2034h, 2037h.
int forward(const ForwardArguments& a) {
  Results results({a.json_file});
  if (a.off == a.way_given)
    throw host::UserError("drive forward needs --way or --off, one of them");
  DriveBus bus(a.bus);
  std::optional<host::NodeClient> node;
  if (a.axis != 0) {
    node.emplace(bus.client_of(static_cast<std::uint8_t>(a.node)));
    host::require_node_ready(*node, static_cast<std::size_t>(a.axis),
                             static_cast<std::uint8_t>(a.drive));
  }
  host::NodeClient client = bus.client_of(static_cast<std::uint8_t>(a.drive));
  const host::ForeignDrive drive = read_with_bar(client);
  bus.require_ready(client, drive);
  const std::vector<host::PdoPlan> plan = host::plan_of(drive, route_of(a));
  require_consent(question_of(a, plan), a.yes);
  std::vector<host::PdoPlan> done;
  bus.change(client,
             [&](host::DriveChanges& changes) { done = host::set_route(changes, drive, plan); });
  if (a.store) host::store_in_drive(client);
  if (node) host::set_node_way(*node, static_cast<std::size_t>(a.axis), route_of(a));
  results.add(a.json_file, json_text(json_of(a, done)));
  results.write();
  for (const host::PdoPlan& one : done)
    fmt::print(results.text(), "{}\n", host::describe(one));
  tell_next(results.text(), a);
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
  CLI::Option* const axis =
      command->add_option("--axis", a->axis,
                          "Axis of the compensation node, from 1: its way is written, too (2034h, "
                          "and 2037h for way 1)");
  axis->check(CLI::Range(1, static_cast<int>(node::kNodeAxes)));
  command->add_option("--node-id", a->node, "With --axis: CANopen node id of the compensation node")
      ->check(CLI::Range(1, 127))
      ->needs(axis)
      ->capture_default_str();
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
