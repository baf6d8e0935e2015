#pragma once
// What a run has read, so that a report can say from which data its figures come.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace volcomp::host {

struct HashedInput {
  std::string what;  // "machine file"
  std::string name;  // without its folder
  std::size_t bytes = 0;
  std::string sha256;  // 64 hexadecimal digits
};

// FIPS 180-4, as 64 hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

// Throws UserError naming the file when it cannot be read.
[[nodiscard]] HashedInput hashed_file(const std::string& what, const std::filesystem::path& path);
// Of something that was made, not read.
[[nodiscard]] HashedInput hashed_bytes(const std::string& what, const std::string& name,
                                       const std::vector<std::uint8_t>& bytes);

}  // namespace volcomp::host
