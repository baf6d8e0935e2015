#pragma once
// Whether a drive may be written for a moment: it stands still, nobody works with it, and no PDO is
// served.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "host_sim/host/bus/drive_check/foreign_drive.hpp"

namespace volcomp::host {

// 1018h:01 to :04; 0 where it has none. Throws what the client throws without an answer.
[[nodiscard]] std::array<std::uint32_t, 4> read_identity(NodeClient& client);

// Bit 2 of 6041h: operation enabled, quick stop active, fault reaction active. The axis may move.
[[nodiscard]] bool is_enabled(std::uint64_t statusword);
// The same, read now.
[[nodiscard]] bool is_enabled(NodeClient& client);

// Sends a guarding frame (remote request 700h + node); false: this link sends none.
using SendGuarding = std::function<bool()>;

// The NMT state as it is now: from a heartbeat, else from the answer to a guarding frame, else
// `heard` (a boot-up). The first guarding frame starts life guarding, and a drive that misses the
// next one stops: none is sent where 1017h, or 100Ch x 100Dh, is not 0. Nothing: it is not known.
[[nodiscard]] std::optional<canopen::NmtState> ask_state(NodeClient& client,
                                                         const ForeignDrive& drive,
                                                         std::optional<canopen::NmtState> heard,
                                                         const SendGuarding& send_guarding);

// Throws UserError with one sentence unless the drive is PRE-OPERATIONAL and not enabled.
void require_ready(NodeClient& client, const ForeignDrive& drive,
                   std::optional<canopen::NmtState> heard, const SendGuarding& send_guarding);
// Throws UserError when its power stage is on.
void require_disabled(NodeClient& client);

}  // namespace volcomp::host
