#pragma once
// Files appear whole or not at all.

#include <filesystem>
#include <string_view>

namespace volcomp::sim {

// Writes beside the target and renames; throws UserError naming the file. An earlier file survives
// a failure.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

// With those above it; one that exists is fine. Throws UserError naming it.
void create_folder(const std::filesystem::path& path);

}  // namespace volcomp::sim
