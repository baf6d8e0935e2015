#pragma once
// The experiments of the paper's section 3.3: the same points touched five times over, each reading
// against the mean of its point; on a plane plate along X, Y and Z, and inside a ring along X and Y
// together. Besides, what deploying the arm anew before each round does.

#include <array>
#include <string>
#include <vector>

#include "host_sim/experiments/face_gear/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::face_gear {

// What is touched, and what the paper says of it: no reading further from the mean, µm.
struct RepeatabilityTask {
  const char* name;
  const char* where;
  double paper_um;
};
inline constexpr std::array<RepeatabilityTask, 4> kRepeatabilityTasks{
    {{"X", "plate, 22 places over 210 mm", 0.6},
     {"Y", "plate, 11 places over 50 mm", 1.2},
     {"Z", "plate, 11 places over 50 mm", 1.8},
     {"X and Y", "ring, 0 to 350 deg", 1.7}}};

// Largest distance of a reading from the mean of its point, µm, by kRepeatabilityTasks.
struct RepeatabilityOnce {
  std::array<double, 4> arm_stays{};
  std::array<double, 4> arm_anew{};
};

struct RepeatabilityResult {
  FaceGearOptions options;
  std::vector<host::HashedInput> inputs;
  std::vector<RepeatabilityOnce> measurement;  // seeds of the options, the next, …
};

// `count` machines, on up to `threads` threads; the same result for any number of these. Of the
// options machine, seed, probe and bus matter. Throws UserError.
[[nodiscard]] RepeatabilityResult run_repeatability(const FaceGearOptions& options,
                                                    std::size_t count, std::size_t threads,
                                                    const host::Progress& progress);

[[nodiscard]] std::string repeatability_summary(const RepeatabilityResult& result);
[[nodiscard]] nlohmann::json repeatability_document(const RepeatabilityResult& result,
                                                    const host::RunContext& run);
[[nodiscard]] nlohmann::json repeatability_figures(const RepeatabilityResult& result);

}  // namespace volcomp::face_gear
