#include "host_sim/host/measure/flank_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/metrology/faces/face_gear_grade.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/gear_choice.hpp"
#include "host_sim/host/measure/map_csv.hpp"

namespace volcomp::host {
namespace {

using Surface = std::array<SurfacePoint, kGridCells>;

// In µm, + = excess material.
ErrorMap map_in_um(const CompareOptions& options, const std::string& file) {
  const ErrorMap read = read_map_file(file);
  const double scale = (options.plus_is_metal ? 1.0 : -1.0) * options.um_per_unit;
  ErrorMap map;
  for (std::size_t i = 0; i < kGridCells; ++i)
    map.set(i / kGridColumns, i % kGridColumns, scale * read.cells()[i]);
  return map;
}

void zero(ErrorMap& map, Zeroing zeroing, const std::string& file) {
  double removed = 0.0;
  if (zeroing == Zeroing::centre) require(zero_at_centre(map, removed), file);
  if (zeroing == Zeroing::mean) require(zero_by_mean(map, removed), file);
}

MeasuredFlank measured_flank(const CompareOptions& options, const std::string& file) {
  MeasuredFlank m;
  m.file = file;
  m.map = map_in_um(options, file);
  if (m.map.missing() == kGridCells) throw UserError(file + ": every cell is empty");
  zero(m.map, options.zeroing, file);
  m.statistics = statistics_of(m.map);
  ProfileDeviation profile;
  const Status s = profile_deviation(m.map, options.profile_rows, profile);
  if (s.ok()) m.profile = profile;
  if (!s.ok() && s.reason != Reason::incomplete) require(s, file);
  return m;
}

FlankPair flank_pair(const CompareOptions& options, std::size_t flank) {
  FlankPair pair;
  pair.name = flank == 0 ? "left" : "right";
  pair.side = flank == 0 ? options.left_side : -options.left_side;
  for (std::size_t k = 0; k < 2; ++k)
    pair.measured.at(k) = measured_flank(options, options.files.at(2 * flank + k));
  require(compare_maps(pair.measured[0].map, pair.measured[1].map, pair.difference),
          fmt::format("{} and {}", pair.measured[0].file, pair.measured[1].file));
  return pair;
}

std::optional<GradedProfile> graded(const std::vector<FlankPair>& flanks, std::size_t measurement) {
  GradedProfile worst;
  for (std::size_t f = 0; f < flanks.size(); ++f) {
    const auto& profile = flanks[f].measured.at(measurement).profile;
    if (!profile) return std::nullopt;
    if (profile->value > worst.value_um) worst = {profile->value, f, profile->column, {}};
  }
  worst.grade = face_gear_grade(worst.value_um);
  return worst;
}

// --- frames

// The nominal flank of a side, in the order of the maps. The grid's own order is that of Table 3:
// tip first, inner end first.
Surface nominal_flank(const CompareOptions& options, const FaceGrid& grid, int side) {
  Surface ordered;
  for (std::size_t row = 0; row < kGridRows; ++row) {
    for (std::size_t column = 0; column < kGridColumns; ++column) {
      const std::size_t from_row = options.row_1_is_tip ? row : kGridRows - 1 - row;
      const std::size_t from_column =
          options.column_1_is_inner ? column : kGridColumns - 1 - column;
      const FaceGridNode& node = grid.at(from_row).at(from_column);
      SurfacePoint p{node.point, node.normal};
      p.point.y() *= side;
      p.normal.y() *= side;
      ordered.at(grid_index(row, column)) = p;
    }
  }
  return ordered;
}

void look_for_frames(FlankComparison& c) {
  GearChoice choice = choose_face_gear(c.options.gear);
  // Relief turns a few normals a little; the figures of docs/papers/face-gear.md are for generated
  // flanks.
  choice.gear.relief = {};
  require(derive(choice.gear), c.options.gear);
  FaceGrid grid;
  require(make_face_grid(choice.gear, choice.plan, grid), c.options.gear);
  std::vector<Surface> nominal;
  for (const FlankPair& pair : c.flanks)
    nominal.push_back(nominal_flank(c.options, grid, pair.side));
  std::vector<ComparedFlank> flanks;
  for (std::size_t f = 0; f < c.flanks.size(); ++f)
    flanks.push_back({&c.flanks[f].difference.difference, nominal[f]});
  const std::array<std::pair<const char*, FrameMotions>, 3> kinds{
      {{"shift in X and Z, a constant for each flank", kShiftInXz},
       {"all six motions", kWholeFrame},
       {"turn about the gear axis", kTurnAboutAxis}}};
  for (const auto& [what, freedom] : kinds) {
    FrameFinding finding{what, {}};
    require(frame_share(flanks, freedom, finding.share), what);
    c.frame.push_back(finding);
  }
}

}  // namespace

FlankComparison compare_flanks(const CompareOptions& options) {
  if (options.files.size() != 2 && options.files.size() != 4)
    throw UserError(
        fmt::format("{} maps given; give two of one flank, or two of the left and two "
                    "of the right flank",
                    options.files.size()));
  FlankComparison c;
  c.options = options;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t flank = 0; 2 * flank < options.files.size(); ++flank) {
    c.flanks.push_back(flank_pair(options, flank));
    const CellStatistics& s = c.flanks.back().difference.overall;
    c.largest_um = std::max(c.largest_um, s.largest);
    squares += s.rms * s.rms * static_cast<double>(s.count);
    count += static_cast<double>(s.count);
  }
  c.rms_um = std::sqrt(squares / count);
  for (std::size_t k = 0; k < 2; ++k)
    c.profile.at(k) = graded(c.flanks, k);
  if (!options.gear.empty()) look_for_frames(c);
  return c;
}

std::string conventions_of(const CompareOptions& options) {
  return fmt::format(
      "um, + = excess material (maps given with + = {}), {}; left = side {:+d}; row 1 = {}, column "
      "1 = {}",
      options.plus_is_metal ? "metal" : "space",
      options.zeroing == Zeroing::centre ? "zeroed at the centre"
      : options.zeroing == Zeroing::mean ? "zeroed by the mean"
                                         : "zeroed as given",
      options.left_side, options.row_1_is_tip ? "tip" : "root",
      options.column_1_is_inner ? "inner" : "outer");
}

std::string grade_text(const std::optional<GradedProfile>& profile) {
  if (!profile) return "no grade: measured values are missing";
  if (profile->grade) return fmt::format("grade {}", *profile->grade);
  return fmt::format("worse than grade {}", kFaceGearLimits.back().grade);
}

}  // namespace volcomp::host
