#include "host_sim/data/whole_file.hpp"

#include <unistd.h>

#include <fstream>

#include <fmt/format.h>

#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {

void write_whole_file(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.tmp", ::getpid());
  std::error_code failed;
  {
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) failed = std::make_error_code(std::errc::io_error);
  }
  if (!failed) std::filesystem::rename(temporary, path, failed);
  if (!failed) return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  throw UserError(fmt::format("{}: cannot be written", path.string()));
}

void create_folder(const std::filesystem::path& path) {
  std::error_code failed;
  std::filesystem::create_directories(path, failed);
  if (failed)
    throw UserError(fmt::format("{}: cannot be created: {}", path.string(), failed.message()));
}

}  // namespace volcomp::sim
