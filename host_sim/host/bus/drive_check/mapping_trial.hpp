#pragma once
// Tries which mappings a drive takes. The PDO that is tried with stays invalid: no frame can act on
// it, even if somebody starts the drive meanwhile. Afterwards the drive is as it was.

#include <cstdint>
#include <set>

#include "host_sim/host/bus/drive_check/drive_changes.hpp"
#include "host_sim/host/bus/drive_check/foreign_drive.hpp"

namespace volcomp::host {

// The PDOs for the trial, numbers from 1.
struct TrialPdos {
  ForeignPdo receive;
  ForeignPdo transmit;
};

// The highest RPDO and TPDO that are invalid; else that map nothing; else, but not the first, whose
// identifier was not among those `heard` on the bus. Throws UserError when there is none.
[[nodiscard]] TrialPdos pdos_for_trial(const ForeignDrive& drive,
                                       const std::set<std::uint16_t>& heard);

// The drive must be ready (drive_ready.hpp). A mapping that it refuses is an answer. Throws
// NotRestored, and after everything is back whatever ended the trial.
[[nodiscard]] TriedMappings try_mappings(DriveChanges& changes, const ForeignDrive& drive,
                                         const TrialPdos& pdos);

}  // namespace volcomp::host
