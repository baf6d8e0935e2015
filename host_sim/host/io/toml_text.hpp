#pragma once
// A whole TOML file, from disk to the tables it holds. Everything throws UserError.

#include <exception>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "host_sim/host/io/toml_section.hpp"
#include "host_sim/host/io/toml_value.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

// The whole file, or as much as parse_toml needs to refuse one that is too large.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& path);

// The top table. Refuses text above 1 MiB and brackets more than 32 deep: no machine file comes
// near.
[[nodiscard]] TomlValue parse_toml(const std::string& text, const std::string& name);

// What `read` makes of the top table.
template <class Read>
auto read_toml(const std::string& text, const std::string& name, const Read& read) {
  const TomlValue top = parse_toml(text, name);
  try {
    return read(top);
  } catch (const UserError&) {
    throw;
  } catch (const std::exception& e) {
    throw UserError(fmt::format("{}: not valid TOML ({})", name, e.what()));
  }
}

}  // namespace volcomp::host
