#pragma once
// Amplitude and phase of what the monitor summed up (comp/strokes/running_statistics.hpp).

#include "comp/core/span.hpp"
#include "comp/strokes/learning.hpp"
#include "comp/strokes/running_statistics.hpp"

namespace volcomp {

struct SpectralLine {
  double amplitude = 0.0;
  double phase = 0.0;  // rad: the part is amplitude · cos(θ + phase)
};

// 0 without samples. The mean of the samples is taken out. θ of a time line is 0 at its first
// sample.
[[nodiscard]] SpectralLine spectral_line(const OrderLine& sums);
[[nodiscard]] SpectralLine spectral_line(const TimeLine& sums);

// An order of C in the means of the slots, 1…slots/2. Form grinding has no tooth mesh: an order q
// of C shows at |q − slots · m|. Slots without samples are left out.
[[nodiscard]] SpectralLine order_around(Span<const NodeSums> slots, int order);

}  // namespace volcomp
