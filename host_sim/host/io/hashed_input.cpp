#include "host_sim/host/io/hashed_input.hpp"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

class Digest {
 public:
  Digest() { demand(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr)); }

  void add(const void* bytes, std::size_t size) {
    demand(EVP_DigestUpdate(context_.get(), bytes, size));
  }

  [[nodiscard]] std::string text() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    demand(EVP_DigestFinal_ex(context_.get(), digest.data(), &size));
    std::string text;
    for (std::size_t i = 0; i < size; ++i)
      text += fmt::format("{:02x}", digest.at(i));
    return text;
  }

 private:
  static void demand(int succeeded) {
    if (succeeded != 1) throw std::runtime_error("SHA-256 is not available in this OpenSSL");
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_{EVP_MD_CTX_new(),
                                                                   &EVP_MD_CTX_free};
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Digest digest;
  digest.add(bytes.data(), bytes.size());
  return digest.text();
}

HashedInput hashed_file(const std::string& what, const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path))
    throw UserError(fmt::format("{}: cannot be opened", path.string()));
  Digest digest;
  std::size_t size = 0;
  std::array<char, 65536> piece{};
  while (stream) {
    stream.read(piece.data(), piece.size());
    const auto got = static_cast<std::size_t>(stream.gcount());
    digest.add(piece.data(), got);
    size += got;
  }
  if (stream.bad()) throw UserError(fmt::format("{}: cannot be read", path.string()));
  return {what, path.filename().string(), size, digest.text()};
}

HashedInput hashed_bytes(const std::string& what, const std::string& name,
                         const std::vector<std::uint8_t>& bytes) {
  const std::string text(bytes.begin(), bytes.end());
  return {what, name, text.size(), sha256(text)};
}

}  // namespace volcomp::host
