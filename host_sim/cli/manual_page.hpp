#pragma once
// volcomp(1), for man: made from the commands themselves.

#include <string>

#include <CLI/CLI.hpp>

namespace volcomp::cli {

// Troff in UTF-8.
[[nodiscard]] std::string manual_page(CLI::App& program);

}  // namespace volcomp::cli
