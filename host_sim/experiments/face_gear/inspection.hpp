#pragma once
// Measuring a face gear: its frame, maps of chosen flanks, the pitch of all teeth
// (docs/papers/face-gear.md, "What we do").

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "comp/metrology/faces/error_map.hpp"
#include "comp/metrology/faces/face_frame.hpp"
#include "comp/metrology/faces/face_grid.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "comp/probe/face_touch.hpp"
#include "host_sim/experiments/face_gear/inspection_plan.hpp"
#include "host_sim/experiments/face_gear/station.hpp"

namespace volcomp::face_gear {

// A frame, and the deployment of the arm it holds for.
struct KnownFrame {
  Frame mounting;
  unsigned deployment = 0;
  std::optional<FaceFrame> fit;  // none: from one ball
  int touches = 0;
};

// One flank over the grid; µm, zeroed at the centre.
struct FlankMap {
  FlankName flank;
  ErrorMap map;
  std::optional<double> profile;  // largest range of a column over rows 2…6; none: cells missing
  std::vector<std::string> missing;  // why, a line for each missing cell
};

// All flanks of one side; µm along the pitch circle.
struct FacePitch {
  std::vector<double> position;  // of each tooth
  PitchDeviations figures;
  double over_10 = 0.0;  // F_pk, k = 10
};

// The node judges every touch with its own kernel; here the same is done on this computer.
struct NodeAgreement {
  int touches = 0;
  std::int64_t largest_nm = 0;  // between the distances from the flank
  int verdicts = 0;             // that were not the same
};

// What is done against scatter.
struct FaceRules {
  int touches = 1;        // of each point; their mean counts
  double sigma_mm = 0.0;  // of a touch, as the class of the probe has it; 0: nothing is an outlier
};

// Touches of one point that are further apart than their scatter explains. They count all the same.
struct OutlierPoint {
  FlankName flank;
  std::size_t row = 0;
  std::size_t column = 0;
  double spread_um = 0.0;  // the largest less the least distance from the flank
};
inline constexpr double kOutlierSigmas = 6.0;

struct FaceInspection {
  NodeAgreement node;
  std::vector<OutlierPoint> outliers;  // in the order of the touches
  KnownFrame frame;
  std::vector<FlankMap> maps;      // left and right of the first chosen slot, then of the next
  std::array<FacePitch, 2> pitch;  // left, right
  std::string program;             // the same in NC words (inspection_program.hpp)
};

inline constexpr std::size_t kPitchSpan = 10;

class FaceInspector {
 public:
  FaceInspector(FaceStation& station, const FaceGear& gear, const FaceGrid& grid,
                double ball_radius, const FaceRules& rules = {});

  // The paper's procedure: takes the turn of the gear about its axis from one touch at the centre
  // of a flank, all else as assumed.
  [[nodiscard]] KnownFrame frame_from_one_ball();
  // All six coordinates from five points of both flanks of three slots.
  [[nodiscard]] KnownFrame frame_from_many();
  void use(const KnownFrame& frame);
  [[nodiscard]] const NodeAgreement& agreement() const { return agreement_; }
  [[nodiscard]] const std::vector<OutlierPoint>& outliers() const { return outliers_; }

  // Throws UserError when the arm was deployed since the frame was found, or nothing was touched.
  [[nodiscard]] FlankMap map(const FlankName& name);
  [[nodiscard]] FacePitch pitch(int side);

 private:
  // Where the ball was, the mean of all touches, and how the worst of them was judged.
  [[nodiscard]] FaceStationTouch touch(const PlannedTouch& planned);
  void agree(const FaceTouch& here, const sim::FlankJudgement& node);
  [[nodiscard]] FaceFlank flank_of(const FlankName& name) const;
  void check_fresh() const;

  FaceStation& station_;
  const FaceGear& gear_;
  const FaceGrid& grid_;
  double radius_;
  KnownFrame frame_;
  FaceRules rules_;
  NodeAgreement agreement_;
  std::vector<OutlierPoint> outliers_;
};

}  // namespace volcomp::face_gear
