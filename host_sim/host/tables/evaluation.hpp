#pragma once
// Evaluates tables at single positions of a machine: its error there, and the offsets that cancel
// it, from the exact chain in double and from the tick that a node runs.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comp/tick/instances.hpp"
#include "host_sim/host/tables/table_model.hpp"

namespace volcomp::host {

// Where tables come from, for texts about them.
struct TableSource {
  std::vector<std::string> files;    // the image, or the machine file and the runs
  std::optional<std::uint32_t> crc;  // of the image; none: built for the evaluation only
};

// Base frame, mm and rad. Beyond its table an axis stands at the end of it, as in the tick.
struct EvaluatedPoint {
  Pose at{};                        // requested position, rounded to run-time units
  std::uint32_t beyond = 0;         // a bit per axis that stands outside its table
  Vec3 position = Vec3::Zero();     // error of the tool point, exact chain
  Vec3 orientation = Vec3::Zero();  // error of the tool's orientation, rotation vector
  bool authority = true;            // false: the correcting axes cannot act here, no offsets
  Pose exact{};                     // offsets by NC axis, from the exact chain
  Pose model{};                     // from the run-time model in double
  std::optional<Pose> tick;         // from the tick; none: more axes or knots than it has room for
};

// How far the offsets of some points are apart at most, of linear (nm) and rotary axes (nrad).
struct OffsetDistance {
  double nm = 0.0;
  double nrad = 0.0;
};

struct Evaluation {
  std::vector<EvaluatedPoint> points;
  OffsetDistance tick_from_model;   // arithmetic and rounding of the tick
  OffsetDistance model_from_exact;  // what the run-time model leaves out
};

// All axes travel alike: up, down, or unknown, which takes the mean of both tables. At the
// temperature of the campaign.
class TableEvaluator {
 public:
  // Throws UserError with `name` for tables that no node would take.
  TableEvaluator(const MachineTables& tables, const std::string& name, Travel travel);

  [[nodiscard]] Evaluation evaluate(const std::vector<Pose>& positions);

  // `count` positions per axis, 2 or more, from end to end of its table; of a whole turn the end is
  // the beginning and left out. The last axis counts fastest. Throws UserError for more than
  // kMostGridPoints in all.
  static constexpr std::size_t kMostGridPoints = 100'000;
  [[nodiscard]] std::vector<Pose> grid(std::size_t count) const;

  [[nodiscard]] const MachineChain& chain() const { return model_.model.chain; }
  [[nodiscard]] Travel travel() const { return travel_; }
  // The axes that take offsets, ascending.
  [[nodiscard]] std::vector<std::size_t> offset_axes() const;
  // Whether the tick promises to stay within 1 nm of its model (docs/conventions.md, section 4);
  // none: there is no tick.
  [[nodiscard]] std::optional<bool> within_1nm() const;

 private:
  [[nodiscard]] EvaluatedPoint evaluate_at(const Pose& position);
  void set_exact(const Pose& held, EvaluatedPoint& point) const;
  void set_model(const Pose& held, EvaluatedPoint& point) const;
  [[nodiscard]] Pose tick_at(const std::array<std::int64_t, kMaxAxes>& units);

  std::string name_;
  Travel travel_;
  Travels travels_{};
  TableModel model_;
  std::unique_ptr<OrientingCompensator> tick_;
};

}  // namespace volcomp::host
