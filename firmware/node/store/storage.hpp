#pragma once
// Where a node keeps its parameters and tables while there is no power, as the node sees it.

#include <cstdint>

#include "comp/core/span.hpp"

namespace volcomp::node {

// How a store answers; a node reports the value of its start in 2600h:0B and the last answer to
// 1010h or 1011h in 2600h:0C.
enum class [[nodiscard]] StoreResult : std::uint8_t{
#define STORE_RESULT(number, name, sentence) name = (number),
#include "firmware/node/states.def"
};

inline constexpr std::uint8_t kStoreResults = 12;

// One plain sentence for a person.
[[nodiscard]] const char* sentence(StoreResult result);

class Storage {
 public:
  // Both parts or neither: done; anything else, and what was stored before is intact.
  virtual StoreResult save(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image) = 0;

  // Reads into the given memory, and the sizes become what was read: loaded or loaded_older. Any
  // other result gives the reason why there is nothing to use. An empty `image` is not read.
  virtual StoreResult load(Span<std::uint8_t>& parameters, Span<std::uint8_t>& image) = 0;

  // done, or why something may be left.
  virtual StoreResult erase() = 0;

  // False: what is stored can be read, and save() and erase() refuse.
  [[nodiscard]] bool writable() const { return writable_; }

 protected:
  explicit Storage(bool writable = true) : writable_(writable) {}
  Storage(const Storage&) = default;
  Storage& operator=(const Storage&) = default;
  ~Storage() = default;

 private:
  bool writable_;
};

}  // namespace volcomp::node
