// With c_functions.cpp: what the compiler expects of a C library in every program (GCC manual,
// "Standards": memcpy, memmove, memset, memcmp), the few more that our code uses, and what the
// mathematics of the GNU C library wants. There is no C library for this processor without an
// operating system in Debian.

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

void* memset(void* to, int value, std::size_t count) {
  auto* t = static_cast<Byte*>(to);
  for (std::size_t i = 0; i < count; ++i)
    t[i] = static_cast<Byte>(value);
  return to;
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
