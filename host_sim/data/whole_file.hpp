#pragma once
// Files appear whole or not at all.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace volcomp::sim {

// All of a file. Throws UserError naming it: cannot be opened, cannot be read, more than `largest`
// bytes.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& path, std::size_t largest);

// Writes beside the target and renames; throws UserError naming the file. An earlier file survives
// a failure.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

struct NamedText {
  std::string name;
  std::string text;
};

// Several files into one folder, made if need be: none is put in place before all are written.
void write_whole_files(const std::filesystem::path& folder, const std::vector<NamedText>& files);

// With those above it; one that exists is fine. Throws UserError naming it.
void create_folder(const std::filesystem::path& path);

}  // namespace volcomp::sim
