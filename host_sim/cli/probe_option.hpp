#pragma once
// --probe of the scenarios that touch: which class of probes their touches are of.

#include <filesystem>
#include <optional>

#include <CLI/CLI.hpp>

namespace volcomp::cli {

// Of sim::kProbeClasses; empty: as the machine file says.
CLI::Option* add_probe_class(CLI::App& scenario, std::optional<std::size_t>& probe);

// As the machine file says; the LP2 of the papers where it says nothing. Throws UserError.
[[nodiscard]] std::size_t probe_class_of(const std::filesystem::path& machine);

}  // namespace volcomp::cli
