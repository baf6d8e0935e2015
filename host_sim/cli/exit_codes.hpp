#pragma once
// Meanings of the exit codes of volcomp, for the help text, the manual page and the commands.

#include <array>
#include <string>

namespace volcomp::cli {

enum class ExitCode : std::uint8_t { done = 0, negative = 1, unusable = 2 };

struct ExitCodeText {
  ExitCode code;
  const char* meaning;
};

inline constexpr std::array<ExitCodeText, 3> kExitCodes{
    {{ExitCode::done, "Done, and the verdict is good where there is one."},
     {ExitCode::negative,
      "Done, but the verdict is negative: a limit is exceeded, a difference was found, a node "
      "refused."},
     {ExitCode::unusable,
      "Not done: options, a file or a bus that cannot be used, or a result that cannot be written. "
      "One sentence on standard error says which and why, and which results stand all the same "
      "when "
      "only the words about them could not be written."}}};

// For the end of main and of std::exit.
[[nodiscard]] constexpr int number(ExitCode code) { return static_cast<int>(code); }

// A line for each, for a help text.
[[nodiscard]] std::string exit_code_lines();

}  // namespace volcomp::cli
