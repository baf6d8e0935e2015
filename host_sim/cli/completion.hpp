#pragma once
// Scripts that let a shell complete commands, options, choices and file names.

#include <string>

#include "host_sim/cli/command_tree.hpp"

namespace volcomp::cli {

// Each stands on its own; all follow the words typed so far to the command they belong to.
[[nodiscard]] std::string bash_completion(const CommandText& program);
[[nodiscard]] std::string zsh_completion(const CommandText& program);
[[nodiscard]] std::string fish_completion(const CommandText& program);

}  // namespace volcomp::cli
