#include "host_sim/cli/exit_codes.hpp"

#include <fmt/format.h>

namespace volcomp::cli {

std::string exit_code_lines() {
  std::string text = "Exit codes:\n";
  for (const ExitCodeText& e : kExitCodes)
    text += fmt::format("  {}  {}\n", number(e.code), e.meaning);
  return text;
}

}  // namespace volcomp::cli
