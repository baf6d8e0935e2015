// volcomp drive check, volcomp drive list

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/host/bus/drive_check/drive_check.hpp"
#include "host_sim/host/bus/drive_check/heard_nodes.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

constexpr std::uint64_t kListen_us = 1'000'000;

struct DriveArguments {
  std::string link;
  std::string eds;
  int drive = 1;
  int node_id = 32;
  std::optional<double> feed_mm;
  double timeout_ms = 1000.0;
  bool ask = false;
  std::string json_file;
};

std::shared_ptr<host::FrameLink> open_bus(const std::string& name) {
  if (name == "loopback")
    throw host::UserError(
        "loopback is a bus inside volcomp run; there is no drive to be met on it");
  return host::open_frame_link(name);
}

// A drive has one SDO server: a request beside somebody else's would break that transfer.
host::ForeignDrive read_from_bus(const DriveArguments& a) {
  const std::shared_ptr<host::FrameLink> link = open_bus(a.link);
  const auto node = static_cast<std::uint8_t>(a.drive);
  host::HeardNodes heard = host::listen(*link, kListen_us);
  if (heard[node].sdo_in_use)
    throw host::UserError(fmt::format(
        "somebody else reads or writes objects of node {}: try again when that is over", a.drive));
  host::NodeClient client(node, host::LinkPump(link));
  client.set_timeout_us(static_cast<std::uint64_t>(a.timeout_ms * 1000.0));
  ProgressBar bar;
  return host::read_drive(client, [&](std::size_t done, std::size_t most) {
    bar.show(static_cast<double>(done) / static_cast<double>(most), "reading objects");
  });
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
  if (a.link.empty() == a.eds.empty())
    throw host::UserError("drive check needs --can or --eds, one of them");
  const host::ForeignDrive drive =
      a.eds.empty()
          ? read_from_bus(a)
          : host::read_drive(host::find_drive_eds(a.eds), static_cast<std::uint8_t>(a.drive));
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
  const std::shared_ptr<host::FrameLink> link = open_bus(a.link);
  host::HeardNodes heard = host::listen(*link, kListen_us);
  if (a.ask) {
    ProgressBar bar;
    host::ask_all(link, heard, [&bar](std::uint8_t node) {
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
      "drive", "What somebody else's CANopen drive can take; nothing is written");
  drive->require_subcommand(1);

  CLI::App* checked = drive->add_subcommand(
      "check", "Read a drive, or its EDS, and say which way of the node fits and what is missing");
  auto c = std::make_shared<DriveArguments>();
  checked->add_option("--can", c->link, fmt::format("Where the drive is: {}", host::kLinkForms));
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
  checked->add_option("--timeout", c->timeout_ms, "For each answer of the drive, ms")
      ->check(number_between(1.0, 60'000.0))
      ->capture_default_str();
  add_json(*checked, *c);
  checked->callback([c, &code] { code = check(*c); });

  CLI::App* listed =
      drive->add_subcommand("list", "Listen to a bus for a second and list who is there");
  auto l = std::make_shared<DriveArguments>();
  listed->add_option("--can", l->link, fmt::format("The bus: {}", host::kLinkForms))->required();
  listed->add_flag("--ask", l->ask,
                   "Also read the device type of nodes 1 to 127 whose SDO servers are quiet");
  add_json(*listed, *l);
  listed->callback([l, &code] { code = list(*l); });
}

}  // namespace volcomp::cli
