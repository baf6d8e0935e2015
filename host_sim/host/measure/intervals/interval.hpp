#pragma once
// Intervals for figures that are extremes, by inversion of a test: the true figures that are
// compatible with the data. For such figures no bound is exact for every truth (K. Hirano, J.
// Porter, Econometrica 80, 2012), and the ordinary bootstrap counts their bias twice; this one is
// exact where nothing is left and where one extreme stands alone, and is held near 95 % between.
// Its constants were chosen by looking at coverage on simulated shapes.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "host_sim/host/measure/intervals/extreme.hpp"

namespace volcomp::host {

struct FigureInterval {
  double estimate = 0.0;   // the figure of the data
  double corrected = 0.0;  // estimate of the true one
  double low = 0.0;        // 95 %: 4 % below, 1 % above
  double high = 0.0;
  double upper95 = 0.0;  // one-sided 95 % bound, for verdicts against a limit
};

// What draws say about a figure: shares of draws, 0…1.
struct ShareOfDraws {
  // In which data as extreme as these come from a truth that is only `figure`; rises with it, but
  // for small drops.
  std::function<double(double figure)> low;
  // In which data no more extreme than these come from a truth as large as `figure`; falls with it.
  std::function<double(double figure)> high;
};

// `top`: larger than any figure in question, to begin with. By 40 halvings each, which are the
// definition: p_low drops where a neighbour is let go.
[[nodiscard]] FigureInterval interval_from(double estimate, double top, const ShareOfDraws& share);

// One draw of the noise of a figure's values, in their order.
template <class Values>
struct NoisyDraws {
  Values data;
  std::vector<double> u;            // of the values, noise alone
  std::vector<double> u_selection;  // and with what is common to all readings
  std::vector<Values> low;          // noise a draw, common errors in it: of the lower end
  std::vector<Values> high;         // noise a draw, without
  std::vector<Values> common;       // common errors a draw; empty: there are none
};

template <class Values>
[[nodiscard]] FigureInterval interval_of(const NoisyDraws<Values>& draws);

}  // namespace volcomp::host
