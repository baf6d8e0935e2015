#include "host_sim/host/io/hashed_input.hpp"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

std::string sha256(std::string_view bytes) {
  std::array<unsigned char, 32> digest{};
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available in this OpenSSL");
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

HashedInput hashed_file(const std::string& what, const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path))
    throw UserError(fmt::format("{}: cannot be opened", path.string()));
  std::string text;
  for (std::array<char, 65536> piece{}; stream;) {
    stream.read(piece.data(), piece.size());
    text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw UserError(fmt::format("{}: cannot be read", path.string()));
  return {what, path.filename().string(), text.size(), sha256(text)};
}

HashedInput hashed_bytes(const std::string& what, const std::string& name,
                         const std::vector<std::uint8_t>& bytes) {
  const std::string text(bytes.begin(), bytes.end());
  return {what, name, text.size(), sha256(text)};
}

}  // namespace volcomp::host
