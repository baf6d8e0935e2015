#pragma once
// Machine files with one thing wrong.

#include <gtest/gtest.h>

#include "host_sim/host/machine/machine_file.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {

[[nodiscard]] inline std::string machine_refusal(const std::string& text) {
  return sim::complaint_of([&] { return parse_machine(text, "m.toml"); });
}

// The file in which one passage reads otherwise.
[[nodiscard]] inline std::string changed(std::string text, const std::string& from,
                                         const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

[[nodiscard]] inline std::string refusal_of(const std::string& text, const std::string& from,
                                            const std::string& to) {
  return machine_refusal(changed(text, from, to));
}

}  // namespace volcomp::host
