// Eigen's functions that take memory, as they are where this is allowed. A linker keeps the first
// of several inline functions of one name: linked before the libraries in which Eigen asserts that
// no memory is taken, this one is it.

#include <cstddef>

#include <Eigen/Core>

namespace {

[[gnu::used]] void* (*const allocate)(std::size_t) = &Eigen::internal::aligned_malloc;
// The assertion itself, which an optimizer leaves out of the function above.
[[gnu::used]] void (*const check)() = &Eigen::internal::check_that_malloc_is_allowed;

}  // namespace
