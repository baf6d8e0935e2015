// volcomp replay

#include <memory>

#include <fmt/format.h>

#include "host_sim/bus_tools/replay.hpp"
#include "host_sim/bus_tools/table_transfer.hpp"
#include "host_sim/cli/commands.hpp"

namespace volcomp::sim {
namespace {

struct ReplayArguments {
  std::string log;
  std::string image;
  int node_id = 32;
};

int replay_log(const ReplayArguments& arguments) {
  const std::vector<std::uint8_t> image =
      arguments.image.empty() ? std::vector<std::uint8_t>() : read_image_file(arguments.image);
  const ReplayResult result =
      replay(read_can_log(arguments.log), static_cast<std::uint8_t>(arguments.node_id), image);
  fmt::print("{}", describe(result));
  return result.equal() ? 0 : 1;
}

}  // namespace

void add_replay_command(CLI::App& app, int& code) {
  CLI::App* command =
      app.add_subcommand("replay", "Feed a recorded bus to a fresh node and compare what it sends");
  auto a = std::make_shared<ReplayArguments>();
  command->add_option("LOG", a->log, "Log of candump -L, from the start of the node on")
      ->required();
  command->add_option("--node-id", a->node_id, "CANopen node id of the compensation node")
      ->check(CLI::Range(1, 127))
      ->capture_default_str();
  command->add_option("--image", a->image,
                      "Tables the node had stored before the log begins (image file)");
  command->callback([a, &code] { code = replay_log(*a); });
}

}  // namespace volcomp::sim
