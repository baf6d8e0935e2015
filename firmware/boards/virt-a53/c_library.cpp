// What the compiler expects of a C library in every program (GCC manual, "Standards": memcpy,
// memmove, memset, memcmp), the few more that our code uses, and what the mathematics of the GNU C
// library wants. There is no C library for this processor without an operating system in Debian.

#include <cstddef>
#include <cstdint>

#include "firmware/boards/virt-a53/exit_code.hpp"
#include "hal/virt/uart.hpp"

namespace {

using Byte = unsigned char;

}  // namespace

extern "C" {

void* memcpy(void* __restrict to, const void* __restrict from, std::size_t count) {
  auto* t = static_cast<Byte*>(to);
  const auto* f = static_cast<const Byte*>(from);
  for (std::size_t i = 0; i < count; ++i)
    t[i] = f[i];
  return to;
}

void* memmove(void* to, const void* from, std::size_t count) {
  auto* t = static_cast<Byte*>(to);
  const auto* f = static_cast<const Byte*>(from);
  const bool forward = reinterpret_cast<std::uintptr_t>(t) < reinterpret_cast<std::uintptr_t>(f);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = forward ? i : count - 1 - i;
    t[k] = f[k];
  }
  return to;
}

void* memset(void* to, int value, std::size_t count) {
  auto* t = static_cast<Byte*>(to);
  for (std::size_t i = 0; i < count; ++i)
    t[i] = static_cast<Byte>(value);
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

char* strncpy(char* __restrict to, const char* __restrict from, std::size_t count) {
  std::size_t i = 0;
  for (; i < count && from[i] != '\0'; ++i)
    to[i] = from[i];
  for (; i < count; ++i)
    to[i] = '\0';
  return to;
}

// sincos() of an infinite number sets it; no code reads it.
thread_local int errno;

// It was compiled with a guard below its return addresses.
extern const std::uintptr_t __stack_chk_guard;
const std::uintptr_t __stack_chk_guard = 0x595E'9FBD'94FD'A766;

[[noreturn]] void __stack_chk_fail() {
  volcomp::hal::virt::uart::put("\nFAULT: a function has overwritten its return address\n");
  end_of_program(volcomp::boards::kFault);
}

}  // extern "C"
