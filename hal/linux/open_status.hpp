#pragma once
// Why something of the operating system could not be opened. The error number (errno) is kept
// beside the reason, 0 where the system reported none.

#include <cstdint>

namespace volcomp::hal {

enum class OpenResult : std::uint8_t {
  ok,
  failed,  // error_number says why
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

}  // namespace volcomp::hal
