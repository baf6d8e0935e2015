#pragma once
// Why something of the operating system could not be opened. The error number (errno) is stored
// beside the reason, 0 where the system reported none.

#include <cstdint>
#include <string>
#include <system_error>

namespace volcomp::hal {

enum class OpenResult : std::uint8_t {
  ok,
  failed,  // reason in error_number
  no_can_in_kernel,
  no_such_interface,
  not_a_can_interface,
  interface_down,
  no_such_folder,
  not_a_pipe,
  wrong_size,
  in_use,
};

struct [[nodiscard]] OpenStatus {
  OpenResult result = OpenResult::ok;
  int error_number = 0;

  [[nodiscard]] constexpr bool ok() const { return result == OpenResult::ok; }
};

// Half a sentence for a person, to stand after the name of what was opened: "can0: no such
// interface".
[[nodiscard]] const char* sentence(OpenResult result);
// The same with the message of the system where only it knows the reason: "the operating system
// refused: Permission denied". For programs of the host: inline, so that the library itself stays
// without a heap.
[[nodiscard]] inline std::string sentence(const OpenStatus& status) {
  std::string what = sentence(status.result);
  if (status.result == OpenResult::failed)
    what += ": " + std::generic_category().message(status.error_number);
  return what;
}

}  // namespace volcomp::hal
