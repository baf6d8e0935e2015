#include "host_sim/host/bus/drive_check/drive_ready.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/host/bus/cia402_objects.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

using canopen::NmtState;

constexpr std::uint64_t kEnabledBit = 1U << 2U;
constexpr std::uint64_t kGuarding_us = 200'000;
// Heartbeats that come more seldom are not waited for.
constexpr std::uint64_t kLongestHeartbeat_ms = 10'000;

bool guarding_is_harmless(const ForeignDrive& drive) {
  return drive.number(0x100C).value_or(0) * drive.number(0x100D).value_or(0) == 0;
}

const char* name_of(NmtState state) {
  switch (state) {
#define NMT_STATE(number, name, title, words) \
  case NmtState::name:                        \
    return title;
#include "firmware/canopen/codes.def"
  }
  return "in no known state";
}

[[noreturn]] void refuse_unknown(const ForeignDrive& drive) {
  const std::uint64_t heartbeat_ms = drive.number(0x1017).value_or(0);
  const std::string why =
      heartbeat_ms > kLongestHeartbeat_ms
          ? fmt::format("its heartbeat comes only every {} s (1017h)", heartbeat_ms / 1000)
      : heartbeat_ms > 0 ? "its heartbeat is not heard"
      : guarding_is_harmless(drive)
          ? "it sends no heartbeat (1017h = 0), and no guarding frame was answered"
          : "it sends no heartbeat (1017h = 0), and a guarding frame would start its life guarding "
            "(100Ch x 100Dh)";
  throw UserError(fmt::format("the state of node {} is not known: {}", drive.node, why));
}

}  // namespace

std::array<std::uint32_t, 4> read_identity(NodeClient& client) {
  std::array<std::uint32_t, 4> identity{};
  for (std::size_t i = 0; i < identity.size(); ++i) {
    const canopen::ObjectId object{0x1018, static_cast<std::uint8_t>(i + 1)};
    try {
      identity[i] = static_cast<std::uint32_t>(number(client.read(object, 8, "1018h")));
    } catch (const NodeRefused&) {  // no such value
    }
  }
  return identity;
}

bool is_enabled(std::uint64_t statusword) { return (statusword & kEnabledBit) != 0; }

bool is_enabled(NodeClient& client) { return is_enabled(client.read(cia402::statusword)); }

std::optional<NmtState> ask_state(NodeClient& client, const ForeignDrive& drive,
                                  std::optional<NmtState> heard,
                                  const SendGuarding& send_guarding) {
  const std::uint64_t heartbeat_ms = drive.number(0x1017).value_or(0);
  if (heartbeat_ms > kLongestHeartbeat_ms) return std::nullopt;
  if (heartbeat_ms > 0) return client.await_heartbeat(1500 * heartbeat_ms + kGuarding_us);
  if (!guarding_is_harmless(drive)) return heard;
  if (!send_guarding || !send_guarding()) return heard;
  const auto answer = client.await_heartbeat(kGuarding_us);
  return answer ? answer : heard;
}

void require_disabled(NodeClient& client) {
  if (is_enabled(client))
    throw UserError(fmt::format("the power stage of node {} is on (6041h): disable it first",
                                client.node_id()));
}

void require_ready(NodeClient& client, const ForeignDrive& drive, std::optional<NmtState> heard,
                   const SendGuarding& send_guarding) {
  const auto state = ask_state(client, drive, heard, send_guarding);
  if (!state) refuse_unknown(drive);
  // A boot-up message ends in PRE-OPERATIONAL (CiA 301, 7.3.2.1).
  if (*state != NmtState::pre_operational && *state != NmtState::boot_up)
    throw UserError(fmt::format("node {} is {}: it must be PRE-OPERATIONAL, where no PDO is served",
                                drive.node, name_of(*state)));
  require_disabled(client);
}

}  // namespace volcomp::host
