// volcomp replay

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/firmware_options.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/replay/replay.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/sim/boards/emulated_node.hpp"

namespace volcomp::cli {
namespace {

struct ReplayArguments {
  std::string log;
  std::string image;
  FirmwareChoice firmware;
  int node_id = 32;
  std::string json_file;
};

// Firmware for the time of a replay, restarted at every restart in the log.
host::ReplayResult replay_into_firmware(const FirmwareChoice& choice,
                                        const std::vector<host::LoggedFrame>& log,
                                        std::uint8_t node_id) {
  const sim::EmulatedBoard board = sim::emulated_board(choice.board);
  std::shared_ptr<sim::EmulatedNode> running;
  const auto start = [&]() -> std::shared_ptr<host::PipeLink> {
    running.reset();  // first, since there is one at a time
    running = std::make_shared<sim::EmulatedNode>(board, choice.image);
    return {running, &running->pipe()};
  };
  host::ReplayResult result;
  try {
    result = host::replay_over_pipe(log, node_id, start);
  } catch (const host::UserError& error) {
    throw host::UserError(error.what() + (running ? running->last_words() : std::string()));
  }
  running->finish();
  return result;
}

host::ReplayResult replay_as_asked(const ReplayArguments& arguments) {
  const std::vector<host::LoggedFrame> log = host::read_can_log(arguments.log);
  const auto node_id = static_cast<std::uint8_t>(arguments.node_id);
  if (arguments.firmware.chosen()) return replay_into_firmware(arguments.firmware, log, node_id);
  if (arguments.image.empty()) return host::replay(log, node_id, {});
  return host::replay(log, node_id, host::read_image_file(arguments.image));
}

nlohmann::json to_json(const host::ReplayResult& r) {
  nlohmann::json difference;
  if (r.difference) {
    difference = {{"line", r.difference->line},
                  {"time_us", r.difference->time_us},
                  {"cycle", r.difference->cycle},
                  {"sync_counter", r.difference->sync_counter},
                  {"what", r.difference->what}};
  }
  nlohmann::json clock_set = nlohmann::json::array();
  for (const host::ClockSet& set : r.clock_set)
    clock_set.push_back({{"line", set.line}, {"by_us", set.by_us}});
  return {{"difference", difference},    {"clock_set", clock_set},  {"ok", r.equal()},
          {"cycles", r.cycles},          {"frames_fed", r.fed},     {"frames_compared", r.compared},
          {"frames_skipped", r.skipped}, {"power_ups", r.power_ups}};
}

int replay_log(const ReplayArguments& arguments) {
  Results results({arguments.json_file},
                  {arguments.log, arguments.image, arguments.firmware.image.string()});
  const host::ReplayResult result = replay_as_asked(arguments);
  results.add(arguments.json_file, json_text(to_json(result)));
  results.write();
  fmt::print(results.text(), "{}", host::describe(result));
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
  CLI::Option* image = command->add_option(
      "--image", a->image, "Tables the node had stored before the log begins (image file)");
  add_firmware_options(*command, a->firmware, "Feed it to the node as firmware")->excludes(image);
  command->add_option("--json", a->json_file, "Write it to this file, too (-: standard output)");
  command->callback([a, &code] { code = replay_log(*a); });
}

}  // namespace volcomp::cli
