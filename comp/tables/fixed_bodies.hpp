#pragma once
// Fixed bodies that hang on an axis, taken together before a tick sees them: where they put what
// they carry, and their constant errors as one error of the axis. To second order, as the tick
// reckons, and in its units and precision: float nm and rad. Usable at compile time.

#include <array>
#include <cstddef>

#include "comp/machine/joint.hpp"

namespace volcomp {

// EX EY EZ EA EB EC
using SmallMotion = std::array<float, 6>;

// E after F, both in one frame: Rx Ry Rz of each, multiplied out to second order. F is added where
// E is whole; where E is the difference of two, what E turns of F alone. Linear in E, so that what
// is interpolated stays so.
[[gnu::noinline]] constexpr void act_after(SmallMotion& e, const SmallMotion& f, bool whole) {
  const float a = e[3];
  const float b = e[4];
  const float c = e[5];
  e[0] += b * f[2] - c * f[1];
  e[1] += c * f[0] - a * f[2];
  e[2] += a * f[1] - b * f[0];
  e[3] -= c * f[4];
  e[4] += c * f[3];
  e[5] -= b * f[3];
  for (std::size_t i = 0; i < 6 && whole; ++i)
    e[i] += f[i];
}

// A frame in the one of its carrier, row-major.
struct FixedFrame {
  std::array<float, 9> R{1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F};
  std::array<float, 3> t_nm{};

  // From element `first` of v on, `step` apart.
  [[nodiscard]] constexpr std::array<float, 3> turned(const float* v, std::size_t step = 1) const {
    std::array<float, 3> out{};
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = R[3 * i] * v[0] + R[3 * i + 1] * v[step] + R[3 * i + 2] * v[2 * step];
    return out;
  }

  // The frame placed here goes on by the fixed part of a joint.
  constexpr void extend_by(const Joint& joint) {
    std::array<float, 9> turn{};
    std::array<float, 3> way{};
    for (std::size_t i = 0; i < 9; ++i)
      turn[i] = static_cast<float>(joint.orientation[i]);
    for (std::size_t i = 0; i < 3; ++i)
      way[i] = static_cast<float>(joint.offset[i] * 1e6);
    way = turned(way.data());
    const std::array<std::array<float, 3>, 3> column{
        turned(turn.data(), 3), turned(turn.data() + 1, 3), turned(turn.data() + 2, 3)};
    for (std::size_t i = 0; i < 3; ++i) {
      t_nm[i] += way[i];
      for (std::size_t k = 0; k < 3; ++k)
        R[3 * i + k] = column[k][i];
    }
  }

  // An error in the frame placed here, as one of the carrier: H E H⁻¹. Rx(a) Ry(b) Rz(c) is the
  // rotation by the vector θ + (bc, −ac, ab)/2, which turns with the frame.
  [[nodiscard]] constexpr SmallMotion error_of_carrier(const SmallMotion& e) const {
    const std::array<float, 3> vector{e[3] + 0.5F * e[4] * e[5], e[4] - 0.5F * e[3] * e[5],
                                      e[5] + 0.5F * e[3] * e[4]};
    const std::array<float, 3> w = turned(vector.data());
    const std::array<float, 3> shift = turned(e.data());
    const std::array<float, 3> once = crossed(w, t_nm);
    const std::array<float, 3> twice = crossed(w, once);
    SmallMotion out{};
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = shift[i] - once[i] - 0.5F * twice[i];
    out[3] = w[0] - 0.5F * w[1] * w[2];
    out[4] = w[1] + 0.5F * w[0] * w[2];
    out[5] = w[2] - 0.5F * w[0] * w[1];
    return out;
  }

 private:
  static constexpr std::array<float, 3> crossed(const std::array<float, 3>& a,
                                                const std::array<float, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
};

inline constexpr FixedFrame kAtCarrier{};

}  // namespace volcomp
