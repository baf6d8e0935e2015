#pragma once
// The file of settings that `volcomp calibrate-probe --out` writes (TOML), read for a node.

#include <filesystem>
#include <string>

#include "host_sim/host/bus/probe_setup.hpp"

namespace volcomp::host {

// Replaces radius, lobing and uncertainties of `probe` by those of the file: all of 2302h:01…10,
// 2304h:01 and 2304h:04, each once, in nm. Throws UserError with file and line: no TOML, another
// object, field or unit, one that is missing or there twice, a value that is not finite or no ball
// can have; `probe` then stays as it was.
void read_probe_calibration(const std::filesystem::path& path, NodeProbe& probe);
void read_probe_calibration(const std::string& text, const std::string& name, NodeProbe& probe);

}  // namespace volcomp::host
