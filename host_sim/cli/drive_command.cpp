// volcomp drive check, volcomp drive list; volcomp drive forward is in drive_forward.cpp

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/drive_bus.hpp"
#include "host_sim/cli/drive_forward.hpp"
#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/host/bus/drive_check/drive_check.hpp"
#include "host_sim/host/bus/drive_check/heard_nodes.hpp"
#include "host_sim/host/bus/drive_check/mapping_trial.hpp"
#include "host_sim/host/bus/drive_check/offset_move.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

struct DriveArguments {
  DriveBusOptions bus;
  std::string eds;
  int drive = 1;
  int node_id = 32;
  std::optional<double> feed_mm;
  bool ask = false;
  bool tries = false;
  bool moves = false;
  bool yes = false;
  std::string json_file;
};

void try_on(const DriveBus& bus, host::NodeClient& client, host::ForeignDrive& drive, bool yes) {
  bus.require_ready(client, drive);
  const host::TrialPdos pdos = host::pdos_for_trial(drive, bus.identifiers());
  require_consent(
      fmt::format("Mappings are tried in RPDO{} and TPDO{} of node {}. Both stay invalid "
                  "meanwhile, and everything is put back.",
                  pdos.receive.number, pdos.transmit.number, drive.node),
      yes);
  bus.change(client, [&](host::DriveChanges& changes) {
    drive.tried = host::try_mappings(changes, drive, pdos);
  });
}

void move_on(const DriveBus& bus, host::NodeClient& client, host::ForeignDrive& drive, bool yes) {
  if (!drive.is_cia402())
    throw host::UserError(
        fmt::format("node {} is no CiA 402 drive: nothing is written to it", drive.node));
  host::require_movable(client, drive);
  require_consent(
      fmt::format("60B0h of node {} is set to +-{} units for a moment. In some old drives it "
                  "starts the motor: take its power away (STO).",
                  drive.node, host::kMovedUnits),
      yes);
  bus.change(client, [&](host::DriveChanges& changes) {
    drive.moved = host::move_offset(client, changes, drive);
  });
}

host::ForeignDrive read_from_bus(const DriveArguments& a) {
  const DriveBus bus(a.bus);
  host::NodeClient client = bus.client_of(static_cast<std::uint8_t>(a.drive));
  host::ForeignDrive drive = read_with_bar(client);
  if (a.tries) try_on(bus, client, drive, a.yes);
  if (a.moves) move_on(bus, client, drive, a.yes);
  return drive;
}

host::ForeignDrive read_from_eds(const DriveArguments& a) {
  if (a.tries || a.moves)
    throw host::UserError("--try and --move need a drive on a bus: --can in place of --eds");
  tell_left_changes(a.bus.journal);
  return host::read_drive(host::find_drive_eds(a.eds), static_cast<std::uint8_t>(a.drive));
}

// Data sheets that come with the program are no files of the user.
std::vector<std::string> input_files(const DriveArguments& a) {
  const std::vector<std::string> names = host::bundled_drives();
  const bool bundled = std::find(names.begin(), names.end(), a.eds) != names.end();
  if (a.eds.empty() || bundled) return {};
  return {a.eds};
}

int check(const DriveArguments& a) {
  Results results({a.json_file}, input_files(a));
  if (a.bus.link.empty() == a.eds.empty())
    throw host::UserError("drive check needs --can or --eds, one of them");
  const host::ForeignDrive drive = a.eds.empty() ? read_from_bus(a) : read_from_eds(a);
  host::DriveCheckOptions options;
  options.node = static_cast<std::uint8_t>(a.node_id);
  options.feed_mm = a.feed_mm;
  const host::DriveCheck found = host::check_drive(drive, options);
  results.add(a.json_file, json_text(host::to_json(found)));
  results.write();
  fmt::print(results.text(), "{}", host::describe(found));
  return number(found.good() ? ExitCode::done : ExitCode::negative);
}

int list(const DriveArguments& a) {
  Results results({a.json_file});
  DriveBus bus(a.bus);
  host::HeardNodes& heard = bus.heard();
  if (a.ask) {
    ProgressBar bar;
    host::ask_all(bus.link(), heard, [&bar](std::uint8_t node) {
      bar.show(node / 127.0, fmt::format("asking node {}", node));
    });
  }
  results.add(a.json_file, json_text(host::to_json(heard)));
  results.write();
  fmt::print(results.text(), "{}", host::describe(heard));
  return 0;
}

void add_json(CLI::App& command, DriveArguments& a) {
  command.add_option("--json", a.json_file,
                     "Write the same facts to this file (-: standard output)");
}

}  // namespace

void add_drive_command(CLI::App& app, int& code) {
  CLI::App* drive = app.add_subcommand(
      "drive", "What somebody else's CANopen drive can take; nothing is written unless asked");
  drive->require_subcommand(1);

  CLI::App* checked = drive->add_subcommand(
      "check", "Read a drive, or its EDS, and say which way of the node fits and what is missing");
  auto c = std::make_shared<DriveArguments>();
  checked->add_option("--can", c->bus.link,
                      fmt::format("Where the drive is: {}", host::kLinkForms));
  checked->add_option("--eds", c->eds,
                      fmt::format("EDS or DCF file of the drive instead, or one of {}",
                                  fmt::join(host::bundled_drives(), ", ")));
  checked->add_option("--node", c->drive, "CANopen node id of the drive")
      ->check(CLI::Range(1, 127))
      ->capture_default_str();
  checked->add_option("--node-id", c->node_id, "CANopen node id of the compensation node")
      ->check(CLI::Range(1, 127))
      ->capture_default_str();
  checked->add_option("--feed", c->feed_mm, "Way of a linear axis in one turn of the drive, mm")
      ->check(number_between(1e-3, 1e3));
  checked->add_option("--timeout", c->bus.timeout_ms, "For each answer of the drive, ms")
      ->check(number_between(1.0, 60'000.0))
      ->capture_default_str();
  checked->add_flag("--try", c->tries,
                    "Also try which mappings the drive takes, in PDOs that stay invalid; then put "
                    "everything back");
  checked->add_flag("--move", c->moves,
                    "Also write 60B0h for a moment and see whether it moves the demand value; take "
                    "the power of the motor away first");
  checked->add_flag("--yes", c->yes, "Do not ask before --try and --move");
  add_journal_option(*checked, c->bus.journal);
  add_json(*checked, *c);
  checked->callback([c, &code] { code = check(*c); });

  CLI::App* listed =
      drive->add_subcommand("list", "Listen to a bus for a second and list who is there");
  auto l = std::make_shared<DriveArguments>();
  listed->add_option("--can", l->bus.link, fmt::format("The bus: {}", host::kLinkForms))
      ->required();
  listed->add_flag("--ask", l->ask,
                   "Also read the device type of nodes 1 to 127 whose SDO servers are quiet");
  add_journal_option(*listed, l->bus.journal);
  add_json(*listed, *l);
  listed->callback([l, &code] { code = list(*l); });
  add_drive_forward(*drive, code);
}

}  // namespace volcomp::cli
