#pragma once
// Sets up the PDOs of a drive for a way of the node, or for a machine without it. The only tool
// that leaves a drive configured otherwise than it was.

#include <string>
#include <vector>

#include "host_sim/host/bus/drive_check/drive_changes.hpp"
#include "host_sim/host/bus/drive_check/foreign_drive.hpp"

namespace volcomp::host {

enum class DriveRoute : std::uint8_t {
  // Way 0: 200h + n {6040h, 607Ah} from the controller, 300h + n {60B0h} from the node.
  offset,
  // Way 1: 200h + n {6040h}, the rest of the frame of the controller skipped, 300h + n {607Ah} from
  // the node; 180h + n with 6061h.
  forwarded,
  // No node: 200h + n {6040h, 607Ah}, nothing on 300h + n.
  direct,
};

// What one PDO is to be.
struct PdoPlan {
  canopen::PdoKind kind = canopen::PdoKind::receive;
  std::size_t number = 1;
  std::uint16_t id = 0;                // 0: invalid
  std::optional<std::uint8_t> type{};  // nothing: as it is
  std::vector<Mapping> mappings{};     // the first that the drive takes
  bool dispensable = false;            // where the drive takes none it stays invalid
};

// With the other PDOs that would get in the way, which become invalid: those that hear or say the
// same identifiers, and RPDOs that map what the node or the controller sends elsewhere.
[[nodiscard]] std::vector<PdoPlan> plan_of(const ForeignDrive& drive, DriveRoute route);

// "RPDO2: 303h {607Ah}, type 1".
[[nodiscard]] std::string describe(const PdoPlan& plan);

// Writes the plan and reads it back; returns what each PDO became. When the drive does not take it,
// or anything else ends it, everything is put back. Throws UserError, NotRestored, and what ended
// it. The drive must be ready (drive_ready.hpp); 1010h is not written.
[[nodiscard]] std::vector<PdoPlan> set_route(DriveChanges& changes, const ForeignDrive& drive,
                                             const std::vector<PdoPlan>& plan);

// 1010h:01 = "save": what the drive holds now is there after power-on, too.
void store_in_drive(NodeClient& client);

// --- the side of the node: before the drive is changed, and after its mapping was read back

// `axis`: from 1. Throws UserError unless the heartbeat of the node says PRE-OPERATIONAL and its
// axis has that drive (2010h), with the axis while one follows targets of the node.
void require_node_ready(NodeClient& client, std::size_t axis, std::uint8_t drive);

// 2034h: 0, 1, or 4 for a drive that needs no node; then, for targets, 2037h = 1. The node forgets
// 2037h when the drive boots or leaves OPERATIONAL: the controller writes it again at every start.
void set_node_way(NodeClient& client, std::size_t axis, DriveRoute route);

}  // namespace volcomp::host
