// Three lives of a node: it stores tables, finds them after a restart of the processor, forgets
// them, and after another one corrects nothing.

#include "comp/tables/image.hpp"
#include "firmware/boards/mps2/exit_code.hpp"
#include "firmware/boards/mps2/reset_cause.hpp"
#include "firmware/canopen/sdo_client.hpp"
#include "firmware/node/node.hpp"
#include "firmware/node/store/record_storage.hpp"
#include "hal/mps2/console.hpp"
#include "tests/target/flash/lives.hpp"

extern "C" {
extern const std::uint8_t tables_begin[];
extern const std::uint8_t tables_end[];
}

namespace {

namespace console = volcomp::hal::mps2::console;
using volcomp::Span;
using volcomp::canopen::SdoClient;
using volcomp::hal::mps2::FlashBlocks;
using volcomp::node::Node;
using volcomp::node::RecordStorage;

constexpr std::uint8_t kNodeId = 32;
constexpr std::uint32_t kSave = 0x65766173;  // "save"
constexpr std::uint32_t kLoad = 0x64616F6C;  // "load"

Span<const std::uint8_t> tables() {
  return {tables_begin, static_cast<std::size_t>(tables_end - tables_begin)};
}

// Hands what the node sends to the client, as long as there is something.
void answer(Node& node, SdoClient& client) {
  volcomp::hal::CanFrame frame;
  while (node.device().offer(frame, 0)) {
    node.device().taken(0);
    if (frame.id == volcomp::canopen::kSdoResponse + kNodeId) client.response(frame.data, 0);
  }
}

bool write(Node& node, volcomp::canopen::ObjectId object, Span<const std::uint8_t> value) {
  SdoClient client;
  client.set_block_threshold(64);
  client.download(object, value, 0);
  volcomp::canopen::SdoData request{};
  while (client.request(request)) {
    node.device().receive({volcomp::canopen::kSdoRequest + kNodeId, 8, request}, 0);
    answer(node, client);
  }
  return client.state() == SdoClient::State::done;
}

template <class T>
bool set(Node& node, volcomp::canopen::ObjectId object, T value) {
  std::array<std::uint8_t, sizeof(T)> bytes{};
  volcomp::store_le(bytes.data(), sizeof(T), value);
  return write(node, object, bytes);
}

// What a node of this life has to have found.
bool found(const Node& node, volcomp::node::StoreResult stored, std::uint32_t active_crc) {
  const volcomp::node::NodeObjects& o = node.objects();
  console::put("result of reading the store ");
  console::put_unsigned(o.stored);
  console::put(", active tables ");
  console::put_hex(o.active_crc);
  console::put("\n");
  return o.stored == static_cast<std::uint8_t>(stored) && o.active_crc == active_crc &&
         node.compensator().active() == (active_crc != 0);
}

// In OPERATIONAL without drives: is there something to correct with?
bool starts_as(Node& node, volcomp::node::NodeState state) {
  node.device().receive({volcomp::canopen::kNmt, 2, {1, kNodeId}}, 0);
  return node.objects().state == static_cast<std::uint8_t>(state);
}

bool live(Node& node, std::uint32_t life) {
  using volcomp::node::NodeState;
  using volcomp::node::StoreResult;
  const std::uint32_t crc = image_crc(tables());
  switch (life) {
    case 1:
      return found(node, StoreResult::nothing_stored, 0) && write(node, {0x2110, 1}, tables()) &&
             set<std::uint8_t>(node, {0x2111, 0}, 3) &&
             set<std::uint32_t>(node, {0x1010, 1}, kSave);
    case 2:
      return found(node, StoreResult::loaded, crc) &&
             set<std::uint32_t>(node, {0x1011, 1}, kLoad) && starts_as(node, NodeState::waiting);
    default:
      return found(node, StoreResult::nothing_stored, 0) && starts_as(node, NodeState::no_tables);
  }
}

}  // namespace

int main() {
  const volcomp::test::Lives lives;
  static FlashBlocks flash;
  if (!flash.attach(volcomp::test::flash_memory())) return volcomp::boards::kCheckFailed;
  static RecordStorage<FlashBlocks> storage(flash);
  static Node node(kNodeId, &storage);
  node.power_on(0);
  SdoClient nobody;
  answer(node, nobody);

  console::put("life ");
  console::put_unsigned(lives.number());
  console::put(": ");
  if (!live(node, lives.number())) return volcomp::boards::kCheckFailed;
  if (lives.number() < 3) volcomp::boards::restart();
  return volcomp::boards::kFine;
}
