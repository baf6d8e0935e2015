#pragma once
// Shared by the cases of docs/papers/face-gear.md: the gear, the flank, the names of verdicts.

#include "comp/probe/face_kernel.hpp"
#include "tests/cases/case_file.hpp"

namespace volcomp::cases {

[[nodiscard]] FaceGear face_gear_of(const json& in);
// Slot 0 where the case names none.
[[nodiscard]] FaceFlank face_flank_of(const FaceGear& gear, const json& in);
// The distance a case names: from the generated flank, or where `relieved` from the relieved.
[[nodiscard]] FaceFoot face_foot_of(const FaceGear& gear, const FaceFlank& flank, const json& in);
// As the cases call them, for instance "ABOVE_TIP".
[[nodiscard]] const char* face_name(Reason reason);

}  // namespace volcomp::cases
