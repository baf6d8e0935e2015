#pragma once
// Records the inputs of a run, so that a report can name the data of its figures.

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
// Hashes data that was made, not read.
[[nodiscard]] HashedInput hashed_bytes(const std::string& what, const std::string& name,
                                       const std::vector<std::uint8_t>& bytes);

}  // namespace volcomp::host
