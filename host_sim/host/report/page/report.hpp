#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace volcomp::host {

// False in a program that was built without node: it has no page to put a document in.
[[nodiscard]] bool has_report_page();

// The files of a document (described in README.md of this folder): report.json, its data, and
// report.html, a self-contained page, if there is one.
[[nodiscard]] std::string report_text(const nlohmann::json& document);
[[nodiscard]] std::string report_html(const nlohmann::json& document);

}  // namespace volcomp::host
