#pragma once
// Charts of the report on the grinder (host_sim/host/report/page/README.md).

#include <nlohmann/json.hpp>

#include "host_sim/experiments/internal_helical/scenario.hpp"

namespace volcomp::internal_helical {

[[nodiscard]] nlohmann::json lag_charts(const InternalHelicalResult& run);
[[nodiscard]] nlohmann::json tracking_charts(const InternalHelicalResult& run);
[[nodiscard]] nlohmann::json slot_chart(const InternalHelicalResult& run);
[[nodiscard]] nlohmann::json spectrum_along_z(const InternalHelicalResult& run);
[[nodiscard]] nlohmann::json spectrum_around_c(const InternalHelicalResult& run);
[[nodiscard]] nlohmann::json learning_chart(const InternalHelicalResult& run);
[[nodiscard]] nlohmann::json stroke_table_chart(const InternalHelicalResult& run);
[[nodiscard]] nlohmann::json slot_table_chart(const InternalHelicalResult& run);
[[nodiscard]] nlohmann::json single_pitch_chart(const InternalHelicalResult& run, std::size_t side);
[[nodiscard]] nlohmann::json cumulative_pitch_charts(const InternalHelicalResult& run);
[[nodiscard]] nlohmann::json profile_charts(const InternalHelicalResult& run);

}  // namespace volcomp::internal_helical
