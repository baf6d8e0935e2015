#include "host_sim/data/whole_file.hpp"

#include <unistd.h>

#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

namespace fs = std::filesystem;

// A file being written beside its target; gone unless it was put in place.
class Draft {
 public:
  Draft(fs::path path, std::string_view content) : path_(std::move(path)), temporary_(path_) {
    temporary_ += fmt::format(".{}.tmp", ::getpid());
    std::ofstream stream(temporary_, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (stream) return;
    discard();
    fail();
  }
  ~Draft() { discard(); }
  Draft(Draft&& other) noexcept
      : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  Draft& operator=(Draft&&) = delete;

  void put_in_place() {
    std::error_code failed;
    fs::rename(temporary_, path_, failed);
    if (failed) fail();
    temporary_.clear();
  }

 private:
  void discard() const {
    if (temporary_.empty()) return;
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  }
  [[noreturn]] void fail() const {
    throw UserError(fmt::format("{}: cannot be written", path_.string()));
  }

  fs::path path_;
  fs::path temporary_;
};

}  // namespace

std::string read_whole_file(const fs::path& path, std::size_t largest) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || fs::is_directory(path))
    throw UserError(fmt::format("{}: cannot be opened", path.string()));
  std::string text(largest + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw UserError(fmt::format("{}: cannot be read", path.string()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > largest)
    throw UserError(fmt::format("{}: larger than {} KiB", path.string(), largest / 1024));
  return text;
}

void write_whole_file(const fs::path& path, std::string_view content) {
  Draft(path, content).put_in_place();
}

void write_whole_files(const fs::path& folder, const std::vector<NamedText>& files) {
  create_folder(folder);
  std::vector<Draft> drafts;
  drafts.reserve(files.size());
  for (const NamedText& file : files) {
    if (fs::is_directory(folder / file.name))
      throw UserError(fmt::format("{}: cannot be written", (folder / file.name).string()));
    drafts.emplace_back(folder / file.name, file.text);
  }
  for (Draft& draft : drafts)
    draft.put_in_place();
}

void create_folder(const fs::path& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  if (failed)
    throw UserError(fmt::format("{}: cannot be created: {}", path.string(), failed.message()));
}

}  // namespace volcomp::sim
