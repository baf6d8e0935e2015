#pragma once
// The storage of a node whose memory can be read and not be written, such as a file on a read-only
// file system.

#include "firmware/node/store/storage.hpp"

namespace volcomp::node {

class ReadOnlyStorage final : public Storage {
 public:
  explicit ReadOnlyStorage(Storage& kept) : Storage(false), kept_(kept) {}

  StoreResult save(Span<const std::uint8_t> /*parameters*/,
                   Span<const std::uint8_t> /*image*/) override {
    return StoreResult::read_only;
  }
  StoreResult load(Span<std::uint8_t>& parameters, Span<std::uint8_t>& image) override {
    return kept_.load(parameters, image);
  }
  StoreResult erase() override { return StoreResult::read_only; }

 private:
  Storage& kept_;
};

}  // namespace volcomp::node
