#pragma once
// A report document (page/README.md, "Document") for people on a terminal and, as its figures, for
// programs: what the page shows is told once, in the document.

#include <string>

#include <nlohmann/json.hpp>

namespace volcomp::host {

// Tables as aligned columns with title and unit in the head, paragraphs, notes, and last the
// verdict: "PASS …" or "FAIL …". Charts are left out. A section with a title has an empty line
// before it and its table indented; one without follows at once. A column without a value in any
// row is left out, unless it has a word for what is missing; truths are "yes" and "no".
[[nodiscard]] std::string text_of(const nlohmann::json& document);
// The sections alone, an array.
[[nodiscard]] std::string text_of_sections(const nlohmann::json& sections);
// One section, its empty line included.
[[nodiscard]] std::string text_of_section(const nlohmann::json& section);

// The tables that have a `name`, by it: each an array of objects, or an object by the texts of the
// first column where the table is `keyed`. Members are the columns that have a `name`; "before/um"
// is the member "um" of an object "before", "at/0" the first element of an array "at".
[[nodiscard]] nlohmann::json figures_of(const nlohmann::json& document);
// Those of one table, which needs no name.
[[nodiscard]] nlohmann::json figures_of_table(const nlohmann::json& table);

// The other way round: a table of facts that are JSON already. A row for each object of the array
// `facts`; its cells are the members that `columns` name, null where there is none.
[[nodiscard]] nlohmann::json fact_table(const std::string& title, const nlohmann::json& facts,
                                        nlohmann::json columns);

}  // namespace volcomp::host
