#pragma once
// Problems of identification as cases have them.

#include "host_sim/host/measure/identify/problem.hpp"
#include "tests/cases/case_file.hpp"

namespace volcomp::cases {

// Throws Refused for what the problem cannot hold: fields that are missing, names that are nothing.
[[nodiscard]] host::identify::Problem problem_of(const json& in);
[[nodiscard]] host::identify::Machine machine_of(const json& in);
[[nodiscard]] host::identify::SetUp setup_of(const host::identify::Machine& machine,
                                             const json& in);
[[nodiscard]] host::identify::Stylus stylus_of(const json& in);
[[nodiscard]] Pose pose_of(const json& in);
[[nodiscard]] std::vector<Pose> poses_of(const json& in);
[[nodiscard]] ErrorSet errors_of(const json& in);

}  // namespace volcomp::cases
