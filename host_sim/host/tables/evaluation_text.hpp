#pragma once
// An evaluation of tables for people, as CSV and as JSON. Errors and offsets in um and urad;
// positions in mm and, for people and in CSV, in degrees.

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/host/tables/evaluation.hpp"

namespace volcomp::host {

[[nodiscard]] nlohmann::json evaluation_json(const TableEvaluator& evaluator,
                                             const Evaluation& evaluation,
                                             const TableSource& source);

// `facts`: those of evaluation_json(). Every point, or with more than kMostShownPoints only the
// largest values.
inline constexpr std::size_t kMostShownPoints = 20;
[[nodiscard]] std::string evaluation_text(const TableEvaluator& evaluator,
                                          const nlohmann::json& facts);

// Where the tables come from as comments, then a row for each point: positions, error, offsets,
// the axes beyond their tables.
[[nodiscard]] std::string evaluation_csv(const TableEvaluator& evaluator,
                                         const nlohmann::json& facts);

}  // namespace volcomp::host
