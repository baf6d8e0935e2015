#include "host_sim/host/bus/drive_check/offset_move.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "host_sim/host/bus/cia402_objects.hpp"
#include "host_sim/host/bus/drive_check/drive_ready.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr canopen::ObjectId kWrittenObject{0x60B0, 0};
constexpr std::uint16_t kDemand = 0x6062;
constexpr std::uint16_t kInternalDemand = 0x60FC;  // in increments
constexpr std::uint64_t kSettle_us = 50'000;       // several cycles of any drive
constexpr std::int64_t kNoise = 2;                 // units by which 6064h may tremble

bool has_four_bytes(const ForeignDrive& drive, std::uint16_t index) {
  const auto found = drive.objects.find({index, 0});
  return found != drive.objects.end() && found->second.bytes == 4;
}

// Where a drive has none, its increments tell the direction.
std::uint16_t demand_of(const ForeignDrive& drive) {
  return has_four_bytes(drive, kDemand) ? kDemand : kInternalDemand;
}

}  // namespace

void require_movable(NodeClient& client, const ForeignDrive& drive) {
  if (!has_four_bytes(drive, kWrittenObject.index))
    throw UserError(fmt::format(
        "60B0h of node {} is no INTEGER32: it is not the offset of CiA 402, and not written",
        drive.node));
  if (!has_four_bytes(drive, demand_of(drive)))
    throw UserError(fmt::format(
        "node {} has neither 6062h nor 60FCh: nothing would show the offset", drive.node));
  require_disabled(client);
}

MovedDemand move_offset(NodeClient& client, DriveChanges& changes, const ForeignDrive& drive) {
  std::array<std::int32_t, 4> demand{};
  changes.run_and_restore([&] {
    std::int32_t units = kMovedUnits;
    for (std::int32_t& value : demand) {
      require_disabled(client);
      changes.write(kWrittenObject, static_cast<std::uint32_t>(units), 4);
      client.let_pass(kSettle_us);
      value = static_cast<std::int32_t>(changes.read({demand_of(drive), 0}));
      units = -units;
    }
  });
  return judge_demand(demand);
}

// Down, up, down, each by twice the offset; increments are another length than units.
MovedDemand judge_demand(const std::array<std::int32_t, 4>& demand) {
  const std::int64_t down = std::int64_t{demand[1]} - demand[0];
  const std::int64_t up = std::int64_t{demand[2]} - demand[1];
  const std::int64_t again = std::int64_t{demand[3]} - demand[2];
  const bool regular = std::abs(down + up) <= kNoise && std::abs(up + again) <= kNoise;
  if (!regular || std::abs(down) <= kNoise) return MovedDemand::unknown;
  return std::abs(down + 2 * std::int64_t{kMovedUnits}) <= kNoise ? MovedDemand::as_named
                                                                  : MovedDemand::otherwise;
}

}  // namespace volcomp::host
