#pragma once
// Records and a small flash for the tests of the record store.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "firmware/node/store/record_storage.hpp"
#include "tests/hal/memory_blocks.hpp"

namespace volcomp::node {

using Bytes = std::vector<std::uint8_t>;

struct Record {
  Bytes parameters;
  Bytes image;
  bool operator==(const Record& o) const { return parameters == o.parameters && image == o.image; }
};

inline Record make_record(std::size_t parameters_size, std::size_t image_size, unsigned seed) {
  std::mt19937 random{seed};  // NOLINT(cert-msc51-cpp): the same bytes every time
  Record record{Bytes(parameters_size), Bytes(image_size)};
  for (std::uint8_t& byte : record.parameters)
    byte = static_cast<std::uint8_t>(random());
  for (std::uint8_t& byte : record.image)
    byte = static_cast<std::uint8_t>(random());
  return record;
}

template <class Flash>
StoreResult save(Flash& flash, const Record& record) {
  return RecordStore<Flash>(flash).save(record.parameters, record.image);
}

template <class Flash>
StoreResult erase_all(Flash& flash) {
  return RecordStore<Flash>(flash).erase_all();
}

// What a device finds after a restart; no record unless the result is loaded.
struct Loaded {
  StoreResult result = StoreResult::nothing_stored;
  Record record{};
};

template <class Flash>
Loaded load(Flash& flash) {
  Bytes parameters(Flash::kSectorBytes);
  Bytes image(Flash::kSectorBytes);
  Span<std::uint8_t> parameters_out(parameters);
  Span<std::uint8_t> image_out(image);
  const StoreResult result = RecordStorage<Flash>(flash).load(parameters_out, image_out);
  if (result != StoreResult::loaded && result != StoreResult::loaded_older) return {result, {}};
  parameters.resize(parameters_out.size());
  image.resize(image_out.size());
  return {result, {parameters, image}};
}

template <class Flash>
void expect_loads(Flash& flash, StoreResult result, const Record& record) {
  const Loaded loaded = load(flash);
  EXPECT_EQ(loaded.result, result) << sentence(loaded.result);
  EXPECT_TRUE(loaded.record == record);
  EXPECT_EQ(flash.misuses(), 0U);
}

}  // namespace volcomp::node
