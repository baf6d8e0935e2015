#include "host_sim/cli/output.hpp"

#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

// /dev/null may take any number of results, and is no result that an input could suffer from.
bool is_device(const std::string& name) {
  std::error_code ignored;
  return std::filesystem::is_character_file(name, ignored);
}

bool are_one_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

// The same for a file to come.
std::filesystem::path place_of(const std::string& name) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(
      std::filesystem::absolute(host::file_behind(name), ignored), ignored);
}

// The folder need not be there yet.
bool is_in_folder(const std::string& name, const std::string& folder) {
  const std::string in_it = (std::filesystem::path(folder) / "any").string();
  return place_of(name).parent_path() == place_of(in_it).parent_path();
}

std::vector<std::string>& in_place() {
  static std::vector<std::string> names;
  return names;
}

}  // namespace

std::string json_text(const nlohmann::json& result) {
  return result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Results::Results(const std::vector<std::string>& names, std::vector<std::string> inputs,
                 const std::string& folder)
    : inputs_(std::move(inputs)) {
  for (const std::string& name : names)
    announce(name);
  if (!folder.empty()) host::require_folder(folder);
  for (const std::string& file : files_announced_)
    if (folder.empty() || !is_in_folder(file, folder)) host::require_place(file);
}

void Results::announce(const std::string& name) {
  if (host::is_standard_output(name)) {
    if (words_ == stderr) throw host::UserError("only one result can go to standard output (-)");
    words_ = stderr;
  } else if (!name.empty() && !is_device(name)) {
    refuse_inputs(name);
    refuse_others(name);
    files_announced_.push_back(name);
  }
}

void Results::refuse_inputs(const std::string& name) const {
  for (const std::string& input : inputs_)
    if (are_one_file(name, input))
      throw host::UserError(fmt::format("{}: a result cannot take the place of an input", name));
}

void Results::refuse_others(const std::string& name) const {
  for (const std::string& other : files_announced_)
    if (are_one_file(name, other) || place_of(name) == place_of(other))
      throw host::UserError(fmt::format("{}: two results cannot have one place", name));
}

void Results::add(const std::string& name, std::string_view content) {
  if (!name.empty()) files_.add(name, content);
}

void Results::add_files(const std::string& folder, const std::vector<host::NamedText>& files) {
  add_folder(folder);
  for (const host::NamedText& file : files) {
    const std::string name = (std::filesystem::path(folder) / file.name).string();
    announce(name);
    add(name, file.text);
  }
}

void Results::write() {
  files_.put_in_place();
  in_place().insert(in_place().end(), files_announced_.begin(), files_announced_.end());
}

std::string standing_results() {
  if (in_place().empty()) return "";
  return fmt::format("; the results stand: {}", fmt::join(in_place(), ", "));
}

void finish_standard_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw host::UserError("standard output: cannot be written");
}

}  // namespace volcomp::cli
