#pragma once
// A machine file as what it means: for `volcomp machine`.

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Everything that follows from the file: chain, lower bodies, axes with their ISO 230-1 errors,
// what the correcting axes can do at worst, what of the orientation is left, size of the tables.
[[nodiscard]] nlohmann::json summary_of(const MachineFile& machine);
// The same for people.
[[nodiscard]] std::string summary_text(const nlohmann::json& facts);

// In short.
[[nodiscard]] std::string short_text(const MachineFile& machine);

}  // namespace volcomp::host
