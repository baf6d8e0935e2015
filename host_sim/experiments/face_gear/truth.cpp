#include "host_sim/experiments/face_gear/truth.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "comp/core/units.hpp"
#include "host_sim/experiments/face_gear/published_maps.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/sim/truth/noise.hpp"
#include "host_sim/sim/truth/seeds.hpp"

namespace volcomp::face_gear {
namespace {

constexpr double kHeight_mm = 200.0;    // of the gear above the table
constexpr double kFirstSlot_rad = 0.3;  // lies anywhere

// Waves over rows and columns, zero at the centre.
ErrorMap synthetic_form(sim::Random& random) {
  constexpr double kForm_um = 3.0;
  const double phase = random.uniform(0.0, 2.0 * kPi);
  ErrorMap map;
  for (std::size_t r = 0; r < kGridRows; ++r) {
    for (std::size_t c = 0; c < kGridColumns; ++c) {
      const double x = static_cast<double>(r) / (kGridRows - 1);
      const double y = static_cast<double>(c) / (kGridColumns - 1);
      map.set(r, c, kForm_um * std::sin(kPi * x + 3.0 * kPi * y + phase));
    }
  }
  double removed = 0.0;
  host::require(zero_at_centre(map, removed), "synthetic form");
  return map;
}

// Three waves a turn and a little of everything else. No eccentricity: a frame that is found on the
// flanks takes it for the place of the axis, and rightly so.
std::vector<double> pitch_errors(int teeth, sim::Random& random) {
  constexpr double kWave_um = 2.5;
  constexpr double kRandom_um = 0.5;
  const double phase = random.uniform(0.0, 2.0 * kPi);
  std::vector<double> um;
  um.reserve(static_cast<std::size_t>(teeth));
  for (int k = 0; k < teeth; ++k)
    um.push_back(kWave_um * std::sin(6.0 * kPi * k / teeth + phase) +
                 random.uniform(-kRandom_um, kRandom_um));
  return um;
}

// Where in the grid a point of the flank lies, in steps from row 0 and column 0.
struct GridPlace {
  double row = 0.0;
  double column = 0.0;
};

struct Between {
  std::size_t first = 0;
  double part = 0.0;
};
Between between(double steps, std::size_t count) {
  const double inside = std::clamp(steps, 0.0, static_cast<double>(count - 1));
  const auto first = std::min(static_cast<std::size_t>(inside), count - 2);
  return {first, inside - static_cast<double>(first)};
}

GridPlace place_in(const FaceGrid& grid, const Vec3& foot) {
  const double x0 = grid[0][0].point.x();
  const double x1 = grid[0][kGridColumns - 1].point.x();
  GridPlace place;
  place.column = (kGridColumns - 1) * (foot.x() - x0) / (x1 - x0);
  const Between c = between(place.column, kGridColumns);
  const auto depth = [&](std::size_t row) {
    return (1.0 - c.part) * grid[row][c.first].point.z() +
           c.part * grid[row][c.first + 1].point.z();
  };
  std::size_t row = 0;
  while (row + 2 < kGridRows && foot.z() > depth(row + 1))
    ++row;
  place.row = static_cast<double>(row) + (foot.z() - depth(row)) / (depth(row + 1) - depth(row));
  return place;
}

double value_at(const ErrorMap& map, const GridPlace& place) {
  const Between r = between(place.row, kGridRows);
  const Between c = between(place.column, kGridColumns);
  const auto along = [&](std::size_t row) {
    return (1.0 - c.part) * map.at(row, c.first) + c.part * map.at(row, c.first + 1);
  };
  return (1.0 - r.part) * along(r.first) + r.part * along(r.first + 1);
}

}  // namespace

FaceGearErrors make_face_errors(const FaceGear& gear, FormTruth form, std::uint64_t seed) {
  sim::Random random(sim::seed_of(seed, sim::SeedOf::gear));
  FaceGearErrors errors;
  for (std::size_t side = 0; side < kFaceSides.size(); ++side) {
    errors.form[side] = form == FormTruth::tables ? published_map(PublishedMap::centre, side)
                                                  : synthetic_form(random);
    errors.pitch[side] = pitch_errors(gear.teeth, random);
  }
  return errors;
}

// A flank that is displaced in the sense of rising slots takes material away on side +1.
sim::FaceDeviation deviation_of(const FaceGearErrors& errors, const FaceGear& gear,
                                const FaceGrid& grid) {
  const auto kept = std::make_shared<std::pair<FaceGearErrors, FaceGrid>>(errors, grid);
  const double along_normal = gear.arm / gear.r_pitch;
  return [kept, along_normal](int side, int slot, const Vec3& foot) {
    const std::size_t s = side > 0 ? 0 : 1;
    const double um = value_at(kept->first.form[s], place_in(kept->second, foot)) -
                      side * along_normal * kept->first.pitch[s][static_cast<std::size_t>(slot)];
    return um / kUmPerMm;
  };
}

Frame face_mounting(const Vec3& origin, double angle, const Vec3& tilt) {
  Mat3 down = Mat3::Identity();
  down(1, 1) = down(2, 2) = -1.0;
  Frame mounting;
  mounting.t = origin;
  mounting.R = axis_rotation(Axis::x, tilt.x()) * axis_rotation(Axis::y, tilt.y()) * down *
               axis_rotation(Axis::z, angle);
  return mounting;
}

Frame nominal_mounting() {
  return face_mounting({0.0, 0.0, kHeight_mm}, kFirstSlot_rad, Vec3::Zero());
}

// Out of centre by what explains the paper's Tables 5 to 8 best (docs/papers/face-gear.md, "How to
// reproduce"), and turned by 1'.
Frame true_mounting() {
  constexpr double kMinute = kPi / 180.0 / 60.0;
  return face_mounting({-41.3e-3, 12e-3, kHeight_mm + 4.1e-3}, kFirstSlot_rad + kMinute,
                       {15e-6, -20e-6, 0.0});
}

}  // namespace volcomp::face_gear
