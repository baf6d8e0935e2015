#pragma once
// The same for programs.

#include <nlohmann/json.hpp>

#include "host_sim/host/bus/explain/catalogue.hpp"

namespace volcomp::host {

// {"word", "codes": […], "objects": […]}
[[nodiscard]] nlohmann::json meaning_json(const std::string& word, const Meaning& meaning);

// {"codes": […]}: all of them.
[[nodiscard]] nlohmann::json catalogue_json();

}  // namespace volcomp::host
