#pragma once
// The storage of a node over an A/B record store on a block device.

#include "firmware/node/store/record_store.hpp"
#include "firmware/node/store/storage.hpp"

namespace volcomp::node {

template <class Blocks>
class RecordStorage final : public Storage {
 public:
  explicit RecordStorage(Blocks& blocks) : store_(blocks) {}

  StoreResult save(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image) override {
    return store_.save(parameters, image);
  }

  StoreResult load(Span<std::uint8_t>& parameters, Span<std::uint8_t>& image) override {
    const StoreResult found = store_.load();
    if (found != StoreResult::loaded && found != StoreResult::loaded_older) return found;
    std::size_t size = 0;
    const StoreResult first = store_.read_parameters(parameters, size);
    if (first != StoreResult::done) return first;
    parameters = {parameters.data(), size};
    if (image.empty()) return found;
    const StoreResult second = store_.read_image(image, size);
    if (second != StoreResult::done) return second;
    image = {image.data(), size};
    return found;
  }

  StoreResult erase() override { return store_.erase_all(); }

 private:
  RecordStore<Blocks> store_;
};

}  // namespace volcomp::node
