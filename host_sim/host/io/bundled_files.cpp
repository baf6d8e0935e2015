#include "host_sim/host/io/bundled_files.hpp"

#include <algorithm>
#include <cstdlib>

namespace volcomp::host {

namespace fs = std::filesystem;

fs::path folder_of(const BundledFiles& files) {
  if (const char* const folder = std::getenv(files.variable); folder != nullptr) return folder;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  fs::path installed = self.parent_path().parent_path() / "share/volcomp" / files.folder;
  if (fs::exists(installed, error)) return installed;
  return fs::path(VOLCOMP_SOURCE_DIR) / files.folder;
}

std::vector<std::string> names_of(const BundledFiles& files) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_of(files), error)) {
    if (entry.path().extension() == files.extension) names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path path_of(const BundledFiles& files, const std::string& name) {
  return folder_of(files) / (name + files.extension);
}

}  // namespace volcomp::host
