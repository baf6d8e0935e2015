// Functions of the C library that nothing calls where time counts. Newlib writes them for speed,
// whatever size is asked for, and takes five times the bytes; on the boards that have it memcpy and
// memset remain its own: frames and process data are copied by them.

#include <cstddef>
#include <cstdint>

namespace {

using Byte = unsigned char;

std::uintptr_t number(const void* address) { return reinterpret_cast<std::uintptr_t>(address); }

}  // namespace

extern "C" {

// Not by <cstring>, which for C++ declares memchr with another answer than C has.
void* memcpy(void* to, const void* from, std::size_t count);

void* memmove(void* to, const void* from, std::size_t count) {
  const std::uintptr_t ahead = number(to) - number(from);
  if (ahead >= count && 0 - ahead >= count) return memcpy(to, from, count);
  auto* t = static_cast<Byte*>(to);
  const auto* f = static_cast<const Byte*>(from);
  const bool forward = ahead >= count;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = forward ? i : count - 1 - i;
    t[k] = f[k];
  }
  return to;
}

int memcmp(const void* a, const void* b, std::size_t count) {
  const auto* x = static_cast<const Byte*>(a);
  const auto* y = static_cast<const Byte*>(b);
  for (std::size_t i = 0; i < count; ++i) {
    if (x[i] != y[i]) return x[i] - y[i];
  }
  return 0;
}

// Without const in the answer, as C has it.
void* memchr(const void* in, int value, std::size_t count) {
  const auto* bytes = static_cast<const Byte*>(in);
  for (std::size_t i = 0; i < count; ++i) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    if (bytes[i] == static_cast<Byte>(value)) return const_cast<Byte*>(bytes + i);
  }
  return nullptr;
}

std::size_t strlen(const char* text) {
  std::size_t length = 0;
  while (text[length] != '\0')
    ++length;
  return length;
}

}  // extern "C"
