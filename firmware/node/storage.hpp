#pragma once
// Where a node keeps its parameters and tables while there is no power, as the node sees it.

#include "comp/span.hpp"

namespace volcomp::node {

class Storage {
 public:
  // Both parts or neither. False: the device reported a failure, what was stored before is intact.
  virtual bool save(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image) = 0;

  enum class Found : std::uint8_t {
    nothing = 0,
    newest = 1,
    older = 2,    // the newest was damaged
    damaged = 3,  // there was something, none of it can be used
  };
  // Reads into the given memory; the sizes become what was read.
  virtual Found load(Span<std::uint8_t>& parameters, Span<std::uint8_t>& image) = 0;

  virtual bool erase() = 0;

 protected:
  Storage() = default;
  Storage(const Storage&) = default;
  Storage& operator=(const Storage&) = default;
  ~Storage() = default;
};

}  // namespace volcomp::node
