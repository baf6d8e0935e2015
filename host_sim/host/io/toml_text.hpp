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

// The whole file, or as much as check_toml_limits needs to refuse one that is too large.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& path);

// Throws UserError for a text that the TOML library cannot take: it recurses once per bracket and
// copies freely, and reads beyond the end of a key in quotes that is not UTF-8 (toml11 3.7). No
// machine file comes near these limits.
void check_toml_limits(const std::string& text, const std::string& name);

// What `read` makes of the top table.
template <class Read>
auto read_toml(const std::string& text, const std::string& name, const Read& read) {
  check_toml_limits(text, name);
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
