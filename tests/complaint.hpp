#pragma once
// The message to a user about refused input.

#include <string>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::sim {

// The sentence of the UserError that the work throws; "accepted" when it throws none.
template <class Work>
[[nodiscard]] std::string complaint_of(const Work& work) {
  try {
    static_cast<void>(work());
  } catch (const host::UserError& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace volcomp::sim
