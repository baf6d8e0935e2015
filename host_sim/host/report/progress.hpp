#pragma once

#include <functional>
#include <string>

namespace volcomp::host {

// How far a scenario is: 0…1, and what is being done.
using Progress = std::function<void(double done, const std::string& what)>;

// What a scenario has shown, in one sentence.
struct Verdict {
  bool ok = false;
  std::string text;
};

}  // namespace volcomp::host
