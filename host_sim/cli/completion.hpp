#pragma once
// What a shell offers for Tab: its script (volcomp completion) asks the program itself.

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace volcomp::cli {

// The word after the name of the program that asks for candidates. It is in no help text.
inline constexpr const char* kCompleteCommand = "__complete";

// Prints what can stand in the place of the last of `words`, which follow the name of the program
// on the command line: a candidate a line, a tab, its description; the shell leaves out what does
// not begin as that word. Returns the exit code: 0, or 1 where the names of files belong.
[[nodiscard]] int print_candidates(const CLI::App& program, std::vector<std::string> words);

}  // namespace volcomp::cli
