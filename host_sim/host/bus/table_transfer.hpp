#pragma once
// Table images to and from a node (2110h…2112h). The node is the judge of an image; here it is
// only carried.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "host_sim/host/bus/node_client.hpp"

namespace volcomp::host {

// The bytes of an image file. Throws UserError for what no node can take: nothing, or more than
// node::kImageCapacity bytes.
[[nodiscard]] std::vector<std::uint8_t> read_image_file(const std::filesystem::path& path);

// Sends the image as staged image of the node. Throws as NodeClient::write.
void send_image(NodeClient& client, const std::vector<std::uint8_t>& image,
                const NodeClient::Progress& progress = {});

// The last complete image that was sent to the node or that it loaded from its store.
[[nodiscard]] std::vector<std::uint8_t> fetch_image(NodeClient& client);

// Has the staged image checked and made ready; activate_tables() then ramps it in. Both throw
// NodeRefused with the node's own reason and its place.
void arm_tables(NodeClient& client);
void activate_tables(NodeClient& client);

// 1010h: parameters and active tables survive a power failure. Not while the node is OPERATIONAL.
void store_all(NodeClient& client);

struct ActiveTables {
  std::uint32_t crc = 0;  // 0: none
  std::uint32_t sequence = 0;
};
[[nodiscard]] ActiveTables active_tables(NodeClient& client);

// The last refusal as 2112h describes it, place first: "axis X, knot 4, channel EA: …". Empty
// without one.
[[nodiscard]] std::string refusal(NodeClient& client);

}  // namespace volcomp::host
