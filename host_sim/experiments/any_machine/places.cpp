#include "host_sim/experiments/any_machine/places.hpp"

#include <algorithm>

#include "comp/machine/tilt.hpp"
#include "comp/metrology/tables/pose_offset.hpp"

namespace volcomp::any_machine {
namespace {

constexpr std::size_t kLinePoints = 21;
constexpr double kFeed_mm_s = 50.0;
constexpr double kRapid_mm_s = 400.0;
constexpr double kInset_mm = 2.0;

Pose reference_pose(const host::MachineFile& file) {
  Pose q{};
  for (std::size_t a = 0; a < file.axes.size(); ++a)
    q[a] = file.axes[a].reference;
  return q;
}

// Signs of the axes of each diagonal, downwards true.
std::vector<std::vector<bool>> senses(std::size_t slides) {
  std::vector<std::vector<bool>> all{std::vector<bool>(slides, false)};
  const std::size_t more = slides == 3 ? 3 : slides == 2 ? 1 : 0;
  for (std::size_t k = 0; k < more; ++k) {
    all.emplace_back(slides, false);
    all.back()[k] = true;
  }
  return all;
}

bool can_correct(const host::MachineFile& file, const Pose& q) {
  constexpr double kMargin = 1.5;  // not at the edge, where the node stops
  MotionOffset offset;
  const MachineChain& chain = file.chain;
  return motion_offset(chain, q, chain.tool_point(), Vec3::Zero(), offset).ok() &&
         offset.authority > kMargin * kMinAuthority;
}

double tilt_of(const MachineChain& chain, const Pose& q, const Vec3& orientation_work) {
  const Mat3 work = chain.ideal(chain.work(), q).R;
  const Mat3 tool = chain.ideal(chain.tool(), q).R;
  const Vec3 turn = tool.transpose() * (work * orientation_work);
  return turn.head<2>().norm();
}

// 0 where the orienting axes fade, or without any.
double steerable_of(const MachineChain& chain, const Pose& q, const Vec3& orientation_work) {
  const Vec3 turn = chain.ideal(chain.work(), q).R * orientation_work;
  PoseOffset offset;
  const Status status = pose_offset(chain, q, chain.tool_point(), Vec3::Zero(), turn, offset);
  if (!status.ok() || offset.grip < kMinTurning) return 0.0;
  const Vec3 tool = tool_axis(chain, q);
  return (turn - turn.dot(tool) * tool - offset.tilt_remainder).norm();
}

Vec3 reachable_deviation(const sim::MotionCell& cell, const MachineChain& chain) {
  return within_reach(chain, cell.target(), cell.deviation_mm());
}

}  // namespace

std::vector<std::size_t> slides_of(const host::MachineFile& file) {
  std::vector<std::size_t> slides;
  for (std::size_t a = 0; a < file.axes.size() && slides.size() < 3; ++a) {
    if (!file.axes[a].rotary) slides.push_back(a);
  }
  return slides;
}

std::vector<sim::MeasuredLine> diagonals_of(const host::MachineFile& file) {
  const std::vector<std::size_t> slides = slides_of(file);
  const Vec3 tool = file.chain.tool_point();
  std::vector<sim::MeasuredLine> lines;
  if (slides.empty()) return lines;
  for (const std::vector<bool>& downwards : senses(slides.size())) {
    sim::MeasuredLine line{"", reference_pose(file), reference_pose(file)};
    line.points = kLinePoints;
    line.feed_mm_s = kFeed_mm_s;
    for (std::size_t k = 0; k < slides.size(); ++k) {
      const host::AxisFile& axis = file.axes[slides[k]];
      const double inset = std::min(kInset_mm, 0.1 * (axis.hi - axis.lo));
      line.name += downwards[k] ? 'N' : 'P';
      line.start[slides[k]] = downwards[k] ? axis.hi - inset : axis.lo + inset;
      line.end[slides[k]] = downwards[k] ? axis.lo + inset : axis.hi - inset;
    }
    const Vec3 way = ideal_points(file.chain, line.end, tool).work -
                     ideal_points(file.chain, line.start, tool).work;
    line.length_mm = way.norm();
    line.along = way / line.length_mm;
    lines.push_back(line);
  }
  return lines;
}

std::vector<Pose> random_poses(const host::MachineFile& file, std::size_t count,
                               std::uint64_t seed) {
  constexpr std::size_t kTries = 50;  // for each, on the average
  sim::Random random(seed);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < kTries * count && poses.size() < count; ++i) {
    Pose q{};
    for (std::size_t a = 0; a < file.axes.size(); ++a)
      q[a] = random.uniform(file.axes[a].lo, file.axes[a].hi);
    if (can_correct(file, q)) poses.push_back(q);
  }
  return poses;
}

Vec3 within_reach(const MachineChain& chain, const Pose& q, const Vec3& error_work) {
  const Mat3 work = chain.ideal(chain.work(), q).R;
  const Vec3 error = work * error_work;
  MotionOffset offset;
  const Status status = motion_offset(chain, q, chain.tool_point(), error, offset);
  if (!status.ok()) return Vec3::Zero();
  return work.transpose() * (error - offset.remainder);
}

sim::MeasuredDiagonal measure_line(sim::MotionCell& cell, const MachineChain& chain,
                                   const sim::MeasuredLine& line) {
  return sim::mean_of_directions(line, sim::pass_along(cell, line, [&](double) {
                                   return line.along.dot(reachable_deviation(cell, chain));
                                 }));
}

std::vector<PlaceReading> measure_places(sim::MotionCell& cell, const MachineChain& chain,
                                         const std::vector<Pose>& poses) {
  std::vector<PlaceReading> readings;
  for (const Pose& q : poses) {
    cell.move_to(q, kRapid_mm_s);
    PlaceReading r;
    r.pose = q;
    r.approach = cell.axes().approach();
    r.deviation_mm = reachable_deviation(cell, chain);
    r.orientation_rad = cell.orientation_rad();
    r.tilt_rad = tilt_of(chain, q, r.orientation_rad);
    r.steerable_rad = steerable_of(chain, q, r.orientation_rad);
    r.offset = cell.axes().offset();
    readings.push_back(r);
  }
  return readings;
}

}  // namespace volcomp::any_machine
