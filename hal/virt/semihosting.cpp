#include "hal/virt/semihosting.hpp"

#include <array>
#include <cstdint>

// In semihosting_call.S.
extern "C" std::int64_t semihosting_call(std::int64_t operation, const void* arguments);

namespace volcomp::hal::virt::semihosting {
namespace {

constexpr std::int64_t kCommandLine = 0x15;
constexpr std::int64_t kExitExtended = 0x20;

}  // namespace

bool command_line(Span<char> text) {
  const std::array<std::uint64_t, 2> arguments = {reinterpret_cast<std::uintptr_t>(text.data()),
                                                  text.size()};
  return semihosting_call(kCommandLine, arguments.data()) == 0;
}

void exit(int code) {
  constexpr std::uint64_t kApplicationExit = 0x20026;  // ADP_Stopped_ApplicationExit
  const std::array<std::uint64_t, 2> arguments = {kApplicationExit,
                                                  static_cast<std::uint64_t>(code)};
  static_cast<void>(semihosting_call(kExitExtended, arguments.data()));
}

}  // namespace volcomp::hal::virt::semihosting
