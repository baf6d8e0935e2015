#include "host_sim/host/bus/drive_check/mapping_facts.hpp"

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace volcomp::host {
namespace {

using canopen::PdoKind;

struct Need {
  std::optional<bool> met;
  const char* lack = nullptr;
};

std::array<Need, 5> needs_of(const ForeignDrive& drive) {
  return {{{drive.receive.size() >= 2, "there is no second RPDO"},
           {drive.may_map(PdoKind::receive, control_alone()), "6040h in no RPDO of its own"},
           {drive.may_map(PdoKind::receive, Mapping{kTargetEntry}), "607Ah in no RPDO of its own"},
           {drive.may_come_at_sync(PdoKind::receive) != false, "no RPDO of type 1"},
           {drive.may_map(PdoKind::transmit, Mapping{kModeEntry}), "6061h in no TPDO"}}};
}

}  // namespace

std::optional<bool> may_be_forwarded(const ForeignDrive& drive) {
  std::optional<bool> all = true;
  for (const Need& need : needs_of(drive)) {
    if (need.met == false) return false;
    if (!need.met) all.reset();
  }
  return all;
}

std::string forwarding_text(const ForeignDrive& drive) {
  const std::optional<bool> may = may_be_forwarded(drive);
  if (!may || (!drive.tried && !drive.rules)) return "only trying tells";
  std::vector<std::string> parts;
  if (*may) {
    parts.emplace_back("6040h alone");
    if (drive.may_map(PdoKind::receive, control_and_four_bytes()) == true)
      parts.emplace_back("with 0007h");
    if (drive.may_map(PdoKind::receive, control_and_single_bytes()) == true)
      parts.emplace_back("with four 0005h");
    return fmt::format("yes: {}", fmt::join(parts, " or "));
  }
  for (const Need& need : needs_of(drive)) {
    if (need.met == false) parts.emplace_back(need.lack);
  }
  return fmt::format("no: {}", fmt::join(parts, ", "));
}

std::string trial_text(const ForeignDrive& drive) {
  return drive.tried
             ? fmt::format(", tried in RPDO{} and TPDO{}", drive.tried->rpdo, drive.tried->tpdo)
             : std::string();
}

}  // namespace volcomp::host
