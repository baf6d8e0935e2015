#pragma once
// What the motion controller writes into a drive before it starts it, and what the node must know
// of the frames of that drive. At every start: a drive that was reset has its default PDOs again,
// and what those listen to on 300h + n may be a command (docs/drives.md).

#include <vector>

#include "host_sim/host/bus/setup_plan.hpp"

namespace volcomp::host {

// SYNC, heartbeats and PDOs, as far as the drive has the objects. A drive without a data sheet has
// the right PDOs already (cia402_objects.hpp), and all objects.
[[nodiscard]] SetupPlan drive_plan(const BusSettings& settings, std::size_t axis);

// What a drive must have mapped before targets are forwarded to it: RPDO1 and RPDO2, from 0. Read
// back before 2037h says so.
[[nodiscard]] std::vector<std::uint32_t> forwarded_mapping(std::size_t receive_pdo);

// The PDOs of the node that hear the drive, where its frames are shorter than usual; empty
// otherwise. After 2010h and 2207h of all axes, which set them to their defaults.
[[nodiscard]] SetupPlan heard_plan(const BusSettings& settings, std::size_t axis);

}  // namespace volcomp::host
