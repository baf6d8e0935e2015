#pragma once
// The block device of hal/block_device.hpp over a file, for a node that runs as a Linux process.
// Behaves like flash: erased bytes are 0xFF and writing can only clear bits. A write that would set
// one is refused whole, because it is a mistake of the store above.

#include <cstddef>
#include <cstdint>

#include "comp/span.hpp"
#include "hal/linux/open_status.hpp"

namespace volcomp::hal {

class FileBlocks {
 public:
  static constexpr std::size_t kSectorBytes = std::size_t{64} * 1024;
  static constexpr std::size_t kSectors = 2;
  static constexpr std::size_t kBytes = kSectorBytes * kSectors;

  FileBlocks() = default;
  FileBlocks(const FileBlocks&) = delete;
  FileBlocks& operator=(const FileBlocks&) = delete;
  ~FileBlocks() { close(); }

  // A missing or empty file becomes an erased one; if power fails meanwhile its bytes hold
  // anything, as after an interrupted erase. Fails with failed, wrong_size or in_use; a file of
  // another size is left as it is.
  OpenStatus open(const char* path);
  void close();

  // All false when the file is closed, the range leaves the device or the system reports an error.
  // write() and erase() return when the data are on the medium.
  bool read(std::size_t at, Span<std::uint8_t> out) const;
  bool write(std::size_t at, Span<const std::uint8_t> bytes);
  bool erase(std::size_t sector);

 private:
  [[nodiscard]] OpenStatus attach(const char* path);
  [[nodiscard]] OpenStatus create();
  [[nodiscard]] bool only_clears_bits(std::size_t at, Span<const std::uint8_t> bytes) const;

  int descriptor_ = -1;
};

}  // namespace volcomp::hal
