#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

// A folder that is removed with its owner.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(
      const std::filesystem::path& parent = std::filesystem::temp_directory_path()) {
    std::string name = (parent / "volcomp-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw UserError("cannot create a temporary folder " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace volcomp::host
