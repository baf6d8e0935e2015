#pragma once
// volcomp drive forward

#include "host_sim/cli/commands.hpp"

namespace volcomp::cli {

void add_drive_forward(CLI::App& drive, int& code);

}  // namespace volcomp::cli
