// A touch of a face gear, from the centre of the ball to the verdict; beside it the same distance
// by the paper's search on a patch through the points.

#include <array>
#include <cmath>

#include <benchmark/benchmark.h>

#include "comp/metrology/faces/face_grid.hpp"
#include "comp/probe/face_relief.hpp"
#include "comp/probe/face_touch.hpp"
#include "host_sim/experiments/face_gear/patch/closest_point.hpp"

namespace volcomp::bench {
namespace {

using face_gear::Parametrisation;
using face_gear::SplinePatch;

// Balls on all points of a flank.
struct Balls {
  FaceGear gear = face_gear_of_table_3();
  FaceFlank flank;
  std::array<Vec3, kGridRows * kGridColumns> centre;

  Balls() {
    FaceGrid grid;
    if (!choose_flank(gear, -1, 40, flank).ok()) return;
    if (!make_face_grid(gear, face_grid_of_table_3(), grid).ok()) return;
    for (std::size_t k = 0; k < centre.size(); ++k) {
      const FaceGridNode& node = grid[k / kGridColumns][k % kGridColumns];
      centre[k] = from_flank(flank, node.point + 0.5 * node.normal);
    }
  }
};

// Each waits for the one before, as a touch waits for its latch.
template <class Distance>
void one_after_the_other(benchmark::State& state, const Distance& distance) {
  const Balls balls;
  std::size_t k = 0;
  double last = 0.0;
  for (auto _ : state) {
    const Vec3& q = balls.centre[k];
    last = distance(balls, Vec3(q.x(), q.y(), q.z() + 1e-300 * last));
    benchmark::DoNotOptimize(last);
    k = k + 1 < balls.centre.size() ? k + 1 : 0;
  }
  if (!std::isfinite(last)) state.SkipWithError("refused");
}

void face_distance(benchmark::State& state) {
  one_after_the_other(state, [](const Balls& balls, const Vec3& q) {
    return distance_from_face(balls.gear, balls.flank, q).distance;
  });
}

void face_touch(benchmark::State& state) {
  one_after_the_other(state, [](const Balls& balls, const Vec3& q) {
    return judge_touch(balls.gear, balls.flank, {0.5, 0.1}, q).deviation;
  });
}

void face_relief_exact(benchmark::State& state) {
  one_after_the_other(state, [](const Balls& balls, const Vec3& q) {
    return distance_from_relieved_face(balls.gear, balls.flank, q).distance;
  });
}

// The patch through the flank of these balls, in which side and slot are those of the balls.
SplinePatch patch_of(const Balls& balls) {
  std::array<Vec3, kGridCells> points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const FaceFoot foot = distance_from_relieved_face(balls.gear, balls.flank, balls.centre[k]);
    points[k] = foot.point;
  }
  SplinePatch patch;
  if (!SplinePatch::through(points, Parametrisation::uniform, patch).ok()) return {};
  return patch;
}

void patch_newton(benchmark::State& state) {
  const SplinePatch patch = patch_of(Balls{});
  one_after_the_other(state, [&patch](const Balls&, const Vec3& q) {
    face_gear::ClosestPoint near;
    return closest_point(patch, q, Vec3::UnitY(), near).ok() ? near.distance : 0.0;
  });
}

void patch_subdivision(benchmark::State& state) {
  const SplinePatch patch = patch_of(Balls{});
  one_after_the_other(state, [&patch](const Balls&, const Vec3& q) {
    face_gear::SubdivisionSearch near;
    return closest_point_by_subdivision(patch, q, 10, 1e-7, near).ok() ? near.distance : 0.0;
  });
}

BENCHMARK(face_distance);
BENCHMARK(face_touch);
BENCHMARK(face_relief_exact);
BENCHMARK(patch_newton);
BENCHMARK(patch_subdivision);

}  // namespace
}  // namespace volcomp::bench
