#pragma once
// Validation of measured runs before anything is computed from them. Used by build_table.

#include "comp/metrology/tables/table_builder.hpp"

namespace volcomp {

inline constexpr std::size_t kMaxRuns = 100;

// The measured data seen in ascending order of the positions.
class AscendingRuns {
 public:
  AscendingRuns(const MeasuredAxis& measured, bool reversed)
      : measured_(measured), reversed_(reversed) {}

  [[nodiscard]] bool reversed() const { return reversed_; }
  [[nodiscard]] std::size_t targets() const { return measured_.positions.size(); }
  [[nodiscard]] double position(std::size_t i) const { return measured_.positions[original(i)]; }
  [[nodiscard]] std::size_t reference() const {
    return original(static_cast<std::size_t>(measured_.reference));
  }
  [[nodiscard]] double value(Span<const Run> runs, std::size_t run, std::size_t target,
                             Eigen::Index channel) const {
    return runs[run][original(target)](channel);
  }
  // Spacing of the uniform grid over the same travel.
  [[nodiscard]] double pitch() const;
  [[nodiscard]] bool uniform() const;
  // Index of target i in the list as it was given.
  [[nodiscard]] std::size_t original(std::size_t i) const {
    return reversed_ ? targets() - 1 - i : i;
  }

 private:
  const MeasuredAxis& measured_;
  bool reversed_;
};

// True when the list runs downwards: its last position is below its first.
[[nodiscard]] bool is_descending(Span<const double> positions);

// Every `where.target` is an index of the list as it was given.
Status check_runs(const MeasuredAxis& measured);

}  // namespace volcomp
