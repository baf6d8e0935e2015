#pragma once
// Errors a user can do something about: one clear sentence naming the file, line, axis or field.

#include <array>
#include <stdexcept>
#include <string>

#include "comp/core/status.hpp"

namespace volcomp::host {

// Printed as it is; the tool then ends with exit code 2.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Names of the six errors of an axis (comp/core), for people.
inline constexpr std::array<const char*, 6> kChannels{"EX", "EY", "EZ", "EA", "EB", "EC"};

// A refusal of the library as text: place first, then the reason. Runs and targets count from 1.
[[nodiscard]] std::string describe(const Status& status);

// Throws UserError("SUBJECT: …") unless the status is ok.
void require(const Status& status, const std::string& subject);

}  // namespace volcomp::host
