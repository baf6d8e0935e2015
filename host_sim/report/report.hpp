#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

namespace volcomp::sim {

// Writes report.html, a self-contained page, and report.json, its data, to a
// directory, which is created if needed. README.md of this folder describes the
// document. Throws std::runtime_error naming the file that could not be written;
// an earlier file of that name is then still whole.
void write_report(const nlohmann::json& document, const std::filesystem::path& directory);

}  // namespace volcomp::sim
