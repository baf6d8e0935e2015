#pragma once
// The lever self-test with a user's own runs: the same axis, measured at two places.

#include <array>
#include <string>

#include "comp/metrology/tables/lever_test.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::host {

struct LeverAngle {
  std::string channel;  // for instance EBX
  double expected_mm = 0.0;
  double found_mm = 0.0;
  double allowed_mm = 0.0;
  bool good = true;
  std::string hint;  // likely cause of such a ratio; empty if unknown
};

struct LeverVerdict {
  char axis = '\0';
  std::size_t targets = 0;
  Vec3 first_point = Vec3::Zero();
  Vec3 second_point = Vec3::Zero();
  std::array<LeverAngle, 2> angle;

  [[nodiscard]] bool good() const { return angle[0].good && angle[1].good; }
};

// `first` was measured at the sensed point of the machine file, `second` at `second_point` (reading
// head → sensed point at machine zero, mm). Throws UserError: not a linear axis, different axes or
// targets, readings that are not finite, what lever_self_test refuses but lever_mismatch.
[[nodiscard]] LeverVerdict check_lever(const MachineFile& machine, const RunsFile& first,
                                       const RunsFile& second, const Vec3& second_point);

}  // namespace volcomp::host
