#pragma once
// The table every report begins with: one figure a line, before and after compensation.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace volcomp::host {

struct BeforeAfter {
  std::string figure;
  double before = 0.0;
  double after = 0.0;
  std::optional<double> truth{};  // what a perfect machine would find
  std::string grade_before{};
  std::string grade_after{};
  const char* unit = "µm";
};

// Columns that no line fills are left out. `highlight`: index of the line the verdict is about.
[[nodiscard]] nlohmann::json before_after_table(const std::vector<BeforeAfter>& lines,
                                                const std::string& note,
                                                std::optional<std::size_t> highlight = {});

}  // namespace volcomp::host
