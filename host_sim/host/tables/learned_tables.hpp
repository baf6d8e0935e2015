#pragma once
// What was learned of a helical grinder: offsets of C along its stroke and from slot to slot.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/node/strokes/learned_image.hpp"

namespace volcomp::host {

// Offsets added to the command of C, rad.
struct LearnedTables {
  double z0_mm = 0.0;  // first node of the stroke
  double pitch_mm = 0.0;
  std::array<std::vector<double>, 2> stroke;  // T1 by direction: Z upwards, Z downwards
  std::vector<double> slot;                   // T2
};

// As a node reads and writes it (2526h:01).
[[nodiscard]] std::vector<std::uint8_t> learned_image(const LearnedTables& tables,
                                                      std::uint32_t machine_id,
                                                      double feed_mm_per_s);
// Of such bytes: nodes and slots as those of `like`, offsets up to `most_rad`. Throws UserError
// with `name`.
[[nodiscard]] LearnedTables read_learned(const std::vector<std::uint8_t>& image,
                                         const LearnedTables& like, std::uint32_t machine_id,
                                         double most_rad, const std::string& name);

}  // namespace volcomp::host
