#pragma once
// The observations of a set-up from its file or, where it has none, the places that it is planned
// at.

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host_sim/host/io/toml_section.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"

namespace volcomp::host::identify {

// Where files are looked for.
struct SetUpFiles {
  std::filesystem::path folder;
  const PlanFiles& given;
};

// Adds the observations to a set-up whose other fields are there, and what belongs to them to the
// plan. Throws UserError.
void read_readings(MeasurementPlan& plan, const SetUpFiles& files, const TomlSection& s,
                   SetUp& setup);

// Both throw UserError with file and line.
[[nodiscard]] std::size_t axis_named(const MeasurementPlan& plan, const TomlSection& s,
                                     const std::string& key, const std::string& name);
template <class Named>
std::size_t index_named(const std::vector<Named>& list, const std::string& name,
                        const TomlSection& s, const std::string& key) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return i;
  s.complain(key, fmt::format("'{}': there is no \"{}\" [{}]", key, name,
                              code(Reason::unknown_reference)));
}

}  // namespace volcomp::host::identify
