#pragma once
// The block device of hal/block_device.hpp over a file, for a node that runs as a Linux process.
// Behaves like the flash of a controller: a program() that is not of whole, erased units is refused
// whole, because it is a mistake of the store above.

#include <cstddef>
#include <cstdint>

#include "comp/core/span.hpp"
#include "hal/block_device.hpp"
#include "hal/linux/open_status.hpp"

namespace volcomp::hal {

class FileBlocks {
 public:
  static constexpr std::size_t kUnitBytes = 32;
  static constexpr std::size_t kSectorBytes = std::size_t{64} * 1024;
  static constexpr std::size_t kSectors = 2;
  static constexpr std::size_t kBytes = kSectorBytes * kSectors;

  FileBlocks() = default;
  FileBlocks(const FileBlocks&) = delete;
  FileBlocks& operator=(const FileBlocks&) = delete;
  ~FileBlocks() { close(); }

  // A missing or empty file becomes an erased one; if power fails meanwhile its bytes hold
  // anything, as after an interrupted erase. A file that may only be read is opened for reading.
  // Fails with failed, wrong_size or in_use; a file of another size is left as it is.
  OpenStatus open(const char* path);
  void close();

  // The file system or the rights of the file allow no writing: program() and erase() fail.
  [[nodiscard]] bool read_only() const { return read_only_; }

  // All fail when the file is closed, the range leaves the device or the system reports an error.
  // program() and erase() return when the data are on the medium.
  BlockRead read(std::size_t at, Span<std::uint8_t> out) const;
  bool program(std::size_t at, Span<const std::uint8_t> bytes);
  bool erase(std::size_t sector);

 private:
  [[nodiscard]] OpenStatus attach(const char* path);
  [[nodiscard]] bool open_file(const char* path);
  [[nodiscard]] OpenStatus create(const char* path);
  [[nodiscard]] bool all_erased(std::size_t at, std::size_t size) const;

  int descriptor_ = -1;
  bool read_only_ = false;
};

}  // namespace volcomp::hal
