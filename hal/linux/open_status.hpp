#pragma once
// Why something of the operating system could not be opened. The error number (errno) is stored
// beside the reason, 0 where the system reported none.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <system_error>

namespace volcomp::hal {

enum class OpenResult : std::uint8_t {
#define OPEN_RESULT(name, sentence) name,
#include "hal/linux/open_results.def"
};

struct [[nodiscard]] OpenStatus {
  OpenResult result = OpenResult::ok;
  int error_number = 0;

  [[nodiscard]] constexpr bool ok() const { return result == OpenResult::ok; }
};

// Half a sentence for a person, to stand after the name of what was opened: "can0: no such
// interface".
[[nodiscard]] inline const char* sentence(OpenResult result) {
  static constexpr std::array kSentences{
#define OPEN_RESULT(name, sentence) sentence,
#include "hal/linux/open_results.def"
  };
  return kSentences[static_cast<std::size_t>(result)];
}
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
