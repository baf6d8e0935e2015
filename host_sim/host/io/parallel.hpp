#pragma once
// Independent work on several threads at a time, with the same results for any number of them.

#include <cstddef>
#include <functional>

namespace volcomp::host {

// Processors that this program may use, at least 1.
[[nodiscard]] std::size_t processors();

// Calls work(0) … work(count − 1), each once and begun in this order, on up to `threads` threads of
// which the caller's is one. Returns when all have ended. When one throws, no more are begun, and
// the exception with the lowest index is thrown: the one that a single thread would have met. The
// new threads never receive signals (host/io/interruption.hpp).
void in_parallel(std::size_t count, std::size_t threads,
                 const std::function<void(std::size_t)>& work);

}  // namespace volcomp::host
