#include "host_sim/host/bus/table_transfer.hpp"

#include <array>

#include <fmt/format.h>

#include "firmware/node/store/storage.hpp"
#include "firmware/node/tables/table_download.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

using canopen::AbortCode;
using node::TableCommand;

namespace {

// Prefers the node's reason, which is more specific than the abort code.
void command(NodeClient& client, TableCommand what, const char* name) {
  try {
    client.write(node::object::table_command.id(), {static_cast<std::uint8_t>(what)}, name);
  } catch (const NodeRefused& refused) {
    if (refused.code == AbortCode::general)
      throw NodeRefused(fmt::format("node {}: {}: {} [abort {:08X}h]", client.node_id(), name,
                                    refusal(client), static_cast<std::uint32_t>(refused.code)),
                        refused.code);
    throw;
  }
}

std::string why_not_saved(NodeClient& client) {
  const auto result = client.read<node::StoreResult>(node::object::store_result);
  return result == node::StoreResult::nothing_stored ? "the node has no store" : sentence(result);
}

}  // namespace

std::vector<std::uint8_t> read_image_file(const std::filesystem::path& path) {
  InputFile file(path);
  const std::string image = file.beginning(node::kImageCapacity + 1);
  if (image.empty()) throw UserError(fmt::format("{}: is empty", file.name()));
  if (image.size() > node::kImageCapacity)
    throw UserError(fmt::format("{}: is larger than any table image ({} bytes)", file.name(),
                                node::kImageCapacity));
  return {image.begin(), image.end()};
}

void send_image(NodeClient& client, const std::vector<std::uint8_t>& image,
                const NodeClient::Progress& progress) {
  client.write(node::object::image.id(), image, "table image", progress);
}

std::vector<std::uint8_t> fetch_image(NodeClient& client) {
  return client.read(node::object::image.id(), node::kImageCapacity, "table image");
}

void arm_tables(NodeClient& client) {
  command(client, TableCommand::validate, "check of the tables");
  command(client, TableCommand::arm, "preparation of the tables");
}

void activate_tables(NodeClient& client) {
  command(client, TableCommand::activate, "activation of the tables");
}

void store_all(NodeClient& client) {
  try {
    client.write(node::object::store.id(), {'s', 'a', 'v', 'e'}, "saving");
  } catch (const NodeRefused& refused) {
    if (refused.code == AbortCode::device_state)
      throw NodeRefused(fmt::format("node {}: saving: only while the machine stands and the node "
                                    "is not OPERATIONAL",
                                    client.node_id()),
                        refused.code);
    if (refused.code == AbortCode::hardware)
      throw NodeRefused(fmt::format("node {}: saving: {}", client.node_id(), why_not_saved(client)),
                        refused.code);
    throw;
  }
}

ActiveTables active_tables(NodeClient& client) {
  return {client.read(node::object::active_crc), client.read(node::object::active_sequence)};
}

std::string refusal(NodeClient& client) {
  const auto reason = client.read(node::object::reason);
  if (reason == 0) return {};
  const auto axis = client.read(node::object::where_axis);
  const auto index = client.read(node::object::where_index);
  // -1, as all bits set, is beyond every channel.
  const auto channel = client.read<std::uint8_t>(node::object::where_channel);
  std::vector<std::string> place;
  if (axis != 0) place.push_back(fmt::format("axis {}", static_cast<char>(axis)));
  if (index >= 0) place.push_back(fmt::format("entry {}", index + 1));
  if (channel < kChannels.size()) place.push_back(fmt::format("channel {}", kChannels[channel]));
  std::string text = client.read(node::object::reason_text);
  if (text.empty()) text = sentence(static_cast<Reason>(reason));  // of a board, which has none
  return place.empty() ? text : fmt::format("{}: {}", fmt::join(place, ", "), text);
}

}  // namespace volcomp::host
