// volcomp setup

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "comp/tables/image.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/probe_calibration_file.hpp"
#include "host_sim/host/bus/setup.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/machine_bus.hpp"

namespace volcomp::cli {
namespace {

struct SetupArguments {
  std::string machine;
  std::string link;
  std::optional<int> node_id;
  std::optional<double> cycle_hz;
  std::string probe;
  std::string tables;
  std::string json_file;
  bool dry_run = false;
  bool no_store = false;
};

// What both forms of the result begin with.
nlohmann::json heading_of(const host::MachineFile& machine, const host::BusSettings& bus) {
  return {{"machine", machine.name},
          {"machine_id", machine.id},
          {"node", bus.node},
          {"period_us", bus.period_us}};
}

// The refusal of an image of another machine comes before anything is written.
std::vector<std::uint8_t> tables_of(const SetupArguments& a, const host::MachineFile& machine) {
  if (a.tables.empty()) return {};
  std::vector<std::uint8_t> image = host::read_image_file(a.tables);
  const Span<const std::uint8_t> bytes{image.data(), image.size()};
  TablesView tables;
  host::require(check_image(bytes, image.size(), tables), a.tables);
  if (tables.provenance.machine_id != machine.id)
    throw host::UserError(fmt::format("{}: tables of machine {}, {} is machine {}", a.tables,
                                      tables.provenance.machine_id, machine.path, machine.id));
  return image;
}

// A calibration replaces radius and lobing of the machine file; delays are those of the file.
host::SetupPlan plan_of(const SetupArguments& a, const host::MachineFile& machine,
                        const host::BusSettings& bus) {
  if (a.probe.empty()) return host::setup_plan(machine, bus);
  host::NodeProbe probe = host::node_probe(machine);
  host::read_probe_calibration(std::filesystem::path(a.probe), probe);
  return host::setup_plan(machine, bus, &probe);
}

int set_up_node(const SetupArguments& a) {
  std::vector<std::string> inputs{a.machine};
  if (!a.tables.empty()) inputs.push_back(a.tables);
  if (!a.probe.empty()) inputs.push_back(a.probe);
  Results results({a.json_file}, inputs);
  if (a.link.empty() && !a.dry_run)
    throw host::UserError("setup needs --can, where the node is, or --dry-run");
  const host::MachineFile machine = host::read_machine_file(a.machine);
  std::optional<std::uint8_t> node;
  if (a.node_id) node = static_cast<std::uint8_t>(*a.node_id);
  const host::BusSettings bus = host::setup_bus(machine, a.cycle_hz, node);
  const host::SetupPlan plan = plan_of(a, machine, bus);
  const std::vector<std::uint8_t> tables = tables_of(a, machine);
  nlohmann::json json = heading_of(machine, bus);
  const std::vector<host::OffsetFacts> offsets = host::node_offsets(machine, bus);
  json["offsets"] = host::offset_json(offsets);
  std::string text = fmt::format("{}: {} (machine {}), node {}, a cycle of {} us\n", machine.path,
                                 machine.name, machine.id, bus.node, bus.period_us);
  text += host::offset_text(offsets);
  ExitCode code = ExitCode::done;
  if (a.dry_run) {
    text += host::describe(plan) +
            fmt::format("{} values, in this order; nothing is sent\n", plan.size());
    json["objects"] = host::to_json(plan);
  } else {
    if (a.link == "loopback")
      throw host::UserError(
          "loopback is a bus inside volcomp run; there is no node to be met on it");
    host::NodeClient client(bus.node, host::LinkPump(host::open_frame_link(a.link)));
    const host::SetupResult done = host::set_up(client, machine, plan, {!a.no_store, tables});
    text += host::describe(done);
    json.update(host::to_json(done));
    if (!done.ok()) code = ExitCode::negative;
  }
  results.add(a.json_file, json_text(json));
  results.write();
  fmt::print(results.text(), "{}", text);
  return number(code);
}

}  // namespace

void add_setup_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "setup", "Write into a compensation node what its machine file determines, and store it");
  auto a = std::make_shared<SetupArguments>();
  command->add_option("--machine", a->machine, "Machine file (-: standard input)")->required();
  command->add_option("--can", a->link, fmt::format("Where the node is: {}", host::kLinkForms));
  command
      ->add_option("--node-id", a->node_id,
                   "CANopen node id of the compensation node (default: that of the machine file)")
      ->check(CLI::Range(1, 127));
  command
      ->add_option("--cycle-hz", a->cycle_hz,
                   "Cycle on the bus (default: that of the machine file)")
      ->check(number_between(host::kLeastCycle_hz, host::kMostCycle_hz));
  command->add_option("--probe", a->probe,
                      "Settings of volcomp calibrate-probe --out in place of the radius of the "
                      "machine file");
  command->add_option("--tables", a->tables,
                      "Image file of volcomp build-tables to activate and store, too");
  command->add_flag("--dry-run", a->dry_run, "Print what would be written, without a bus");
  command->add_flag("--no-store", a->no_store, "Write only: lost when the power of the node fails");
  command->add_option(
      "--json", a->json_file,
      "Write what was written and what was there before to this file (-: standard output)");
  command->callback([a, &code] { code = set_up_node(*a); });
}

}  // namespace volcomp::cli
