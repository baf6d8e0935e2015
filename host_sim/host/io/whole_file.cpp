#include "host_sim/host/io/whole_file.hpp"

#include <unistd.h>

#include <fmt/format.h>

#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

namespace fs = std::filesystem;

std::string read_whole_file(const fs::path& path, std::size_t largest) {
  InputFile file(path);
  std::string text = file.beginning(largest + 1);
  if (text.size() > largest)
    throw UserError(fmt::format("{}: larger than {} KiB", file.name(), largest / 1024));
  return text;
}

void write_whole_file(const fs::path& path, std::string_view content) {
  FileDraft draft(path);
  draft.write(content);
  draft.complete();
  draft.put_in_place();
}

WholeFiles::~WholeFiles() {
  drafts_.clear();
  std::error_code ignored;
  for (const fs::path& folder : new_folders_)
    fs::remove(folder, ignored);  // only an empty one
}

void WholeFiles::add_folder(const fs::path& path) {
  std::vector<fs::path> made;
  std::error_code ignored;
  for (fs::path p = path; !p.empty() && !fs::exists(p, ignored); p = p.parent_path())
    made.push_back(p);
  const SignalsHeld until_registered;
  new_folders_.insert(new_folders_.begin(), made.begin(), made.end());
  create_folder(path);
  for (auto folder = made.rbegin(); folder != made.rend(); ++folder)
    removals_.push_back(std::make_unique<RemovedBySignal>(*folder));
}

void WholeFiles::add(const fs::path& path, std::string_view text) {
  if (is_written_directly(path)) {
    direct_.push_back({path, std::string(text)});
    return;
  }
  FileDraft& draft = drafts_.emplace_back(path);
  draft.write(text);
  draft.complete();
}

void WholeFiles::put_in_place() {
  for (const Direct& direct : direct_)
    write_whole_file(direct.path, direct.text);
  removals_.clear();
  for (FileDraft& draft : drafts_)
    draft.put_in_place();
  new_folders_.clear();
}

void require_folder(const fs::path& path) {
  std::error_code ignored;
  fs::path there = fs::absolute(path, ignored);
  while (!fs::exists(there, ignored) && there.has_relative_path())
    there = there.parent_path();
  if (!fs::is_directory(there, ignored) || ::access(there.c_str(), W_OK) != 0)
    throw UserError(fmt::format("{}: cannot be created or written", path.string()));
}

void create_folder(const fs::path& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  if (failed)
    throw UserError(fmt::format("{}: cannot be created: {}", path.string(), failed.message()));
}

}  // namespace volcomp::host
