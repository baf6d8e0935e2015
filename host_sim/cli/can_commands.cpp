// volcomp download, volcomp upload, volcomp diagnose

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "comp/tables/image.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/bus/setup.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

constexpr std::uint64_t kHeartbeat_us = 1'000'000;

struct CanArguments {
  std::string link;
  int node_id = 32;
  std::string image;
  std::string json_file;
  bool no_activate = false;
  bool store = false;
};

host::NodeClient connect(const CanArguments& arguments) {
  if (arguments.link == "loopback")
    throw host::UserError("loopback is a bus inside volcomp run; there is no node to be met on it");
  return {static_cast<std::uint8_t>(arguments.node_id),
          host::LinkPump(host::open_frame_link(arguments.link))};
}

std::uint32_t crc_of(const std::vector<std::uint8_t>& image) {
  return image_crc({image.data(), image.size()});
}

void send_with_progress(host::NodeClient& client, const std::vector<std::uint8_t>& image) {
  ProgressBar bar;
  const auto all = static_cast<double>(image.size());
  host::send_image(client, image, [&](std::size_t bytes) {
    bar.show(static_cast<double>(bytes) / all, fmt::format("{} of {} bytes", bytes, image.size()));
  });
}

// Reads the CRC back, because the node may have activated other tables than those sent.
host::ActiveTables activate(host::NodeClient& client, const std::vector<std::uint8_t>& image) {
  host::activate_tables(client);
  const host::ActiveTables tables = host::active_tables(client);
  if (tables.crc != crc_of(image))
    throw host::UserError(
        fmt::format("node {} has other tables active, CRC-32 {:08X}: somebody else "
                    "works on it",
                    client.node_id(), tables.crc));
  return tables;
}

int download(const CanArguments& arguments) {
  Results results({arguments.json_file}, {arguments.image});
  std::FILE* const words = results.text();
  const std::vector<std::uint8_t> image = host::read_image_file(arguments.image);
  host::NodeClient client = connect(arguments);
  if (arguments.store) host::refuse_while_following(client, client.await_heartbeat(kHeartbeat_us));
  send_with_progress(client, image);
  fmt::print(words, "{}: {} bytes sent to node {}\n", arguments.image, image.size(),
             client.node_id());
  host::arm_tables(client);
  nlohmann::json result{{"node", client.node_id()},
                        {"bytes", image.size()},
                        {"crc32", fmt::format("{:08X}", crc_of(image))},
                        {"active", !arguments.no_activate},
                        {"stored", arguments.store}};
  if (arguments.no_activate) {
    fmt::print(words, "checked and ready, not active: CRC-32 {:08X}\n", crc_of(image));
  } else {
    const host::ActiveTables tables = activate(client, image);
    fmt::print(words, "active: CRC-32 {:08X}, sequence number {}\n", tables.crc, tables.sequence);
    result["sequence_number"] = tables.sequence;
  }
  if (arguments.store) {
    host::store_all(client);
    fmt::print(words, "stored\n");
  }
  results.add(arguments.json_file, json_text(result));
  results.write();
  return 0;
}

int upload(const CanArguments& arguments) {
  Results results({arguments.image, arguments.json_file});
  host::NodeClient client = connect(arguments);
  const std::vector<std::uint8_t> image = host::fetch_image(client);
  results.add(arguments.image, {reinterpret_cast<const char*>(image.data()), image.size()});
  const nlohmann::json result{{"node", client.node_id()},
                              {"bytes", image.size()},
                              {"crc32", fmt::format("{:08X}", crc_of(image))}};
  results.add(arguments.json_file, json_text(result));
  results.write();
  fmt::print(results.text(), "{}: {} bytes, CRC-32 {:08X}\n", shown_output(arguments.image),
             image.size(), crc_of(image));
  return 0;
}

int diagnose_node(const CanArguments& arguments) {
  Results results({arguments.json_file});
  host::NodeClient client = connect(arguments);
  const nlohmann::json diagnosis = host::diagnose(client);
  fmt::print(results.text(), "{}", host::describe(diagnosis));
  results.add(arguments.json_file, json_text(diagnosis));
  results.write();
  return 0;
}

// What the node refuses is a verdict, not bad input.
int judged(int (*command)(const CanArguments&), const CanArguments& arguments) {
  try {
    return command(arguments);
  } catch (const host::NodeRefused& refused) {
    fmt::print(stderr, "volcomp: {}\n", refused.what());
    return 1;
  }
}

std::shared_ptr<CanArguments> add_node_options(CLI::App& command) {
  auto a = std::make_shared<CanArguments>();
  command.add_option("--can", a->link, fmt::format("Where the node is: {}", host::kLinkForms))
      ->required();
  command.add_option("--node-id", a->node_id, "CANopen node id of the compensation node")
      ->check(CLI::Range(1, 127))
      ->capture_default_str();
  return a;
}

}  // namespace

void add_can_commands(CLI::App& app, int& code) {
  CLI::App* to_node =
      app.add_subcommand("download", "Send a table image to a compensation node and activate it");
  const auto d = add_node_options(*to_node);
  to_node->add_option("IMAGE", d->image, "Image file of volcomp build-tables (-: standard input)")
      ->required();
  CLI::Option* no_activate =
      to_node->add_flag("--no-activate", d->no_activate, "Have it checked and prepared only");
  to_node->add_flag("--store", d->store, "Keep parameters and tables through a power failure")
      ->excludes(no_activate);
  to_node->add_option("--json", d->json_file,
                      "Write what was done to this file (-: standard output)");
  to_node->callback([d, &code] { code = judged(download, *d); });

  CLI::App* from_node = app.add_subcommand("upload", "Read the table image of a compensation node");
  const auto u = add_node_options(*from_node);
  from_node->add_option("IMAGE", u->image, "File to write (-: standard output)")->required();
  from_node->add_option("--json", u->json_file,
                        "Write its length and CRC to this file (-: standard output)");
  from_node->callback([u, &code] { code = judged(upload, *u); });

  CLI::App* diagnosis =
      app.add_subcommand("diagnose", "Say in words how a compensation node is doing");
  const auto n = add_node_options(*diagnosis);
  diagnosis->add_option("--json", n->json_file, "Write it to this file, too (-: standard output)");
  diagnosis->callback([n, &code] { code = judged(diagnose_node, *n); });
}

}  // namespace volcomp::cli
