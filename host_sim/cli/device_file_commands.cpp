// volcomp device-files

#include <memory>

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/device_files/dbc.hpp"
#include "host_sim/host/bus/device_files/eds.hpp"
#include "host_sim/host/bus/explain/catalogue.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

struct DeviceFileArguments {
  std::string eds;
  std::string dbc;
  std::string objects;
  std::string reasons;
  std::string axes = "XYZ";
  std::vector<int> drives{1, 2, 3};
  int node = 32;
  int controller = 127;
};

// ISO 841: A, B and C turn.
bool is_rotary(char letter) { return letter >= 'A' && letter <= 'C'; }

host::BusSettings bus_of(const DeviceFileArguments& a) {
  if (a.axes.size() != a.drives.size()) {
    throw host::UserError(
        fmt::format("--axes names {} axes, --drives {} drives", a.axes.size(), a.drives.size()));
  }
  host::BusSettings bus;
  bus.node = static_cast<std::uint8_t>(a.node);
  bus.controller = static_cast<std::uint8_t>(a.controller);
  for (std::size_t i = 0; i < a.axes.size(); ++i) {
    host::BusAxis axis;
    axis.letter = a.axes[i];
    axis.drive = static_cast<std::uint8_t>(a.drives[i]);
    axis.rotary = is_rotary(axis.letter);
    bus.axes.push_back(axis);
  }
  return bus;
}

int write_device_files(const DeviceFileArguments& a) {
  if (a.eds.empty() && a.dbc.empty() && a.objects.empty() && a.reasons.empty())
    throw host::UserError("nothing to write: give --eds, --dbc, --objects or --reasons");
  Results results({a.eds, a.dbc, a.objects, a.reasons});
  results.add(a.eds, host::make_eds());
  results.add(a.dbc, host::make_dbc(bus_of(a)));
  results.add(a.objects, host::object_page());
  results.add(a.reasons, std::string(host::reason_page()));
  results.write();
  return 0;
}

}  // namespace

void add_device_files_command(CLI::App& app, int& code) {
  CLI::App* files = app.add_subcommand("device-files",
                                       "Write the compensation node's EDS, the CAN database of a "
                                       "machine's bus, and pages about both");
  auto a = std::make_shared<DeviceFileArguments>();
  const CLI::Range node_id(1, static_cast<int>(canopen::kMaxNodeId));
  files->add_option("--eds", a->eds,
                    "Electronic data sheet to write, for configuration tools (-: standard output)");
  files->add_option("--dbc", a->dbc, "CAN database to write, for log tools (-: standard output)");
  files->add_option("--objects", a->objects,
                    "Page that explains every object of the node, to write (Markdown)");
  files->add_option("--reasons", a->reasons,
                    "Page that explains every reason and code, to write (Markdown)");
  files->add_option("--node-id", a->node, "Node id of the compensation node (database)")
      ->check(node_id)
      ->capture_default_str();
  files->add_option("--controller", a->controller, "Node id of the motion controller (database)")
      ->check(node_id)
      ->capture_default_str();
  files->add_option("--axes", a->axes, "Letters of the axes; A, B and C are rotary (database)")
      ->capture_default_str();
  files->add_option("--drives", a->drives, "Node ids of their drives, in this order (database)")
      ->delimiter(',')
      ->check(node_id)
      ->capture_default_str();
  files->callback([a, &code] { code = write_device_files(*a); });
}

}  // namespace volcomp::cli
