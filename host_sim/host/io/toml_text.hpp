#pragma once
// A whole TOML file, from disk to the tables it holds. Everything throws UserError.

#include <exception>
#include <filesystem>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "host_sim/host/io/toml_section.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

// Of one that refuse_monsters will find too large, not more than it takes to see that.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& path);

// The TOML library recurses once per bracket and copies freely; no file of ours comes near these
// limits. Of a key in quotes that is not UTF-8 it reads beyond the end (toml11 3.7).
void refuse_monsters(const std::string& text, const std::string& name);

// What `read` makes of the top table.
template <class Read>
auto read_toml(const std::string& text, const std::string& name, const Read& read) {
  refuse_monsters(text, name);
  try {
    std::istringstream stream(text);
    return read(toml::parse(stream, name));
  } catch (const toml::exception& e) {
    throw UserError(fmt::format("{}:{}: not valid TOML", name, e.location().line()));
  } catch (const std::exception& e) {
    if (dynamic_cast<const UserError*>(&e) != nullptr) throw;
    throw UserError(fmt::format("{}: not valid TOML ({})", name, e.what()));
  }
}

}  // namespace volcomp::host
