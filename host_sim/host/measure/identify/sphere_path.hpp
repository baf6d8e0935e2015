#pragma once
// The way of a tip that touches a sphere five times, as planned_spheres.hpp has it, clear of the
// other spheres of its artefact. Between spheres it travels in a plane across the pole, in front of
// all of them.

#include <array>
#include <optional>
#include <vector>

#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/problem.hpp"

namespace volcomp::host::identify {

struct SphereTouch {
  std::vector<Pose> way;  // to it; the last is where probing begins
  Pose target{};          // beyond the contact, towards the centre
};

struct SpherePath {
  Pose above{};  // the first pose, as high as the travels let
  std::vector<Pose> to_first;
  std::vector<SphereTouch> touches;
  std::vector<Pose> away;     // back into the plane
  Pose above_end{};           // the last pose, as high as the travels let
  Vec3 begin = Vec3::Zero();  // tip in the plane, before and after; work frame
  Vec3 end = Vec3::Zero();
};

// Paths of the spheres of a placement with one tip, rotary axes standing still.
class SpherePaths {
 public:
  // `observations` of a set-up that has a pose, all with one tip, at positions where the tip stands
  // in the centre. Both outlive it.
  SpherePaths(const Problem& problem, const SetUp& setup,
              const std::vector<std::size_t>& observations);

  // None where the travels or another sphere leave no room.
  [[nodiscard]] std::optional<SpherePath> of(std::size_t observation) const;
  // Whether the tip may travel straight between two places of the plane.
  [[nodiscard]] bool may_travel(const Vec3& from, const Vec3& to) const {
    return is_free({}, {from, to});
  }
  // Whether the tip passes over all spheres where it is highest.
  [[nodiscard]] bool above_all() const;
  // Away from the table, work frame: its Z with the rotary axes at their references.
  [[nodiscard]] const Vec3& up() const { return up_; }

 private:
  struct Ball {
    Vec3 centre = Vec3::Zero();
    double contact = 0.0;  // distance of the centres at a touch
  };

  // Of all spheres but the one that is touched.
  [[nodiscard]] bool is_free(std::optional<std::size_t> touched,
                             const std::vector<Vec3>& way) const;

  const Problem& problem_;
  const SetUp& setup_;
  std::vector<Ball> balls_;    // by sphere
  std::array<Vec3, 5> out_{};  // ways out of a sphere, the pole first
  Vec3 up_ = Vec3::UnitZ();
  double plane_ = 0.0;  // of travelling, along the pole
  double top_ = 0.0;    // of the tip, along up
};

// The pose after the linear axes have moved the tip, rotary axes standing still.
[[nodiscard]] Pose moved(const MachineChain& chain, const Pose& q, const Vec3& way);

}  // namespace volcomp::host::identify
