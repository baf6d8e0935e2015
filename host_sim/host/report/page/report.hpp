#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace volcomp::host {

// Of a document (README.md of this folder describes it): report.json, its data, and report.html, a
// self-contained page.
[[nodiscard]] std::string report_text(const nlohmann::json& document);
[[nodiscard]] std::string report_html(const nlohmann::json& document);

}  // namespace volcomp::host
