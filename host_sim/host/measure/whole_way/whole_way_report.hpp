#pragma once
// The uncertainty of a task as text, as JSON and as a page with it drawn along the task.

#include <array>

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/whole_way/whole_way.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::host {

// The error of the tool point in base, in the order of PlaceUncertainty.
inline constexpr std::array<const char*, 3> kErrorComponents{"EX", "EY", "EZ"};

// What was asked, and of what.
struct WholeWayQuestion {
  std::string image;  // name
  std::uint32_t crc = 0;
  const MachineFile& machine;
  const std::vector<RunsFile>& runs;
  const CampaignStatement& stated;
  const Task& task;
  const WholeWaySettings& settings;
};

[[nodiscard]] nlohmann::json uncertainty_json(const WholeWayQuestion& q, const TaskUncertainty& u);
[[nodiscard]] nlohmann::json uncertainty_document(const WholeWayQuestion& q,
                                                  const TaskUncertainty& u, const RunContext& run,
                                                  Origins origins);
[[nodiscard]] std::string uncertainty_text(const WholeWayQuestion& q, const TaskUncertainty& u);

}  // namespace volcomp::host
