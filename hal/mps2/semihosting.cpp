#include "hal/mps2/semihosting.hpp"

#include <array>
#include <cstring>

extern "C" int semihosting_call(int operation, const void* arguments);

namespace volcomp::hal::mps2::semihosting {
namespace {

enum Operation : int {
  kOpen = 0x01,
  kWrite = 0x05,
  kRead = 0x06,
  kClock = 0x10,
  kCommandLine = 0x15,
  kExitExtended = 0x20,
};

using Word = std::uintptr_t;

Word address(const void* p) { return reinterpret_cast<Word>(p); }

bool found = false;

}  // namespace

void find_host() { found = semihosting_call(kClock, nullptr) >= 0; }
bool host_found() { return found; }

int open(const char* path, Mode mode) {
  Word length = 0;
  while (path[length] != '\0')
    ++length;
  const std::array<Word, 3> arguments = {address(path), static_cast<Word>(mode), length};
  return semihosting_call(kOpen, arguments.data());
}

bool read(int handle, Span<std::uint8_t> bytes) {
  const std::array<Word, 3> arguments = {static_cast<Word>(handle), address(bytes.data()),
                                         bytes.size()};
  return semihosting_call(kRead, arguments.data()) == 0;  // else the number of bytes not read
}

bool write(int handle, Span<const std::uint8_t> bytes) {
  const std::array<Word, 3> arguments = {static_cast<Word>(handle), address(bytes.data()),
                                         bytes.size()};
  return semihosting_call(kWrite, arguments.data()) == 0;
}

bool command_line(Span<char> text) {
  const std::array<Word, 2> arguments = {address(text.data()), text.size()};
  return semihosting_call(kCommandLine, arguments.data()) == 0;
}

void exit(int code) {
  constexpr Word kApplicationExit = 0x20026;  // ADP_Stopped_ApplicationExit
  const std::array<Word, 2> arguments = {kApplicationExit, static_cast<Word>(code)};
  static_cast<void>(semihosting_call(kExitExtended, arguments.data()));
}

}  // namespace volcomp::hal::mps2::semihosting
