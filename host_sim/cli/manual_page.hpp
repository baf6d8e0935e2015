#pragma once
// volcomp(1), for man: troff made from the commands themselves.

#include <string>

#include "host_sim/cli/command_tree.hpp"

namespace volcomp::cli {

[[nodiscard]] std::string manual_page(const CommandText& program);

}  // namespace volcomp::cli
