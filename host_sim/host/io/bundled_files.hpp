#pragma once
// Files that come with the program: machines, data sheets of drives.

#include <filesystem>
#include <string>
#include <vector>

namespace volcomp::host {

struct BundledFiles {
  const char* folder;     // "machines"
  const char* extension;  // ".toml"
  const char* variable;   // of the environment, which names another folder
};

// An installed program has them beside it, one that was just built in its source folder.
[[nodiscard]] std::filesystem::path folder_of(const BundledFiles& files);
// Without extension, in the order of the alphabet.
[[nodiscard]] std::vector<std::string> names_of(const BundledFiles& files);
[[nodiscard]] std::filesystem::path path_of(const BundledFiles& files, const std::string& name);

}  // namespace volcomp::host
