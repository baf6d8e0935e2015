#pragma once
// One-dimensional interpolation for commissioning: linear, Catmull-Rom and PCHIP cubic Hermite. The
// rule of the project: cubic off line onto a finer uniform grid, linear on line.

#include <cstdint>

#include "comp/core/span.hpp"

namespace volcomp {

enum class Interpolation : std::uint8_t { linear, catmull_rom, pchip };
enum class Ends : std::uint8_t { hold, extend_linearly };

// Slopes at the knots (dy/dx). Knots strictly increasing, at least 2 (linear) or 3 (cubic; two
// knots give the secant). PCHIP takes any spacing: weighted harmonic mean (Fritsch and Butland),
// which for equal spacing is 2ab/(a+b). Catmull-Rom wants equal spacing: central differences,
// parabolic ends. Linear needs no slopes.
void knot_slopes(Interpolation kind, Span<const double> x, Span<const double> y,
                 Span<double> slopes);

// Value at `at`; `slopes` may be empty for linear. Outside the knots the end value is held, or the
// curve continued with the end slope (linear: the end segment).
[[nodiscard]] double interpolate(Interpolation kind, Ends ends, Span<const double> x,
                                 Span<const double> y, Span<const double> slopes, double at);

}  // namespace volcomp
