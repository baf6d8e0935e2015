#pragma once
// The storage of a node over an A/B record store on a block device.

#include "firmware/node/record_store.hpp"
#include "firmware/node/storage.hpp"

namespace volcomp::node {

template <class Blocks>
class RecordStorage final : public Storage {
 public:
  explicit RecordStorage(Blocks& blocks) : store_(blocks) {}

  bool save(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image) override {
    return store_.save(parameters, image) == StoreResult::done;
  }

  Found load(Span<std::uint8_t>& parameters, Span<std::uint8_t>& image) override {
    const StoreResult result = store_.load();
    if (result == StoreResult::nothing_stored) return Found::nothing;
    if (result != StoreResult::loaded && result != StoreResult::loaded_older) return Found::damaged;
    std::size_t parameter_bytes = 0;
    std::size_t image_bytes = 0;
    const bool wants_image = image.data() != nullptr;
    if (store_.read_parameters(parameters, parameter_bytes) != StoreResult::done ||
        (wants_image && store_.read_image(image, image_bytes) != StoreResult::done)) {
      return Found::damaged;
    }
    parameters = {parameters.data(), parameter_bytes};
    image = {image.data(), image_bytes};
    return result == StoreResult::loaded ? Found::newest : Found::older;
  }

  bool erase() override { return store_.erase_all() == StoreResult::done; }

 private:
  RecordStore<Blocks> store_;
};

}  // namespace volcomp::node
