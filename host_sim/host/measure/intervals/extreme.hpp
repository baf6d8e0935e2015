#pragma once
// Figures that are extremes of many values, and what the values would be if the true figure were
// another one.
//
// An extreme of noisy values is biased upwards, and no estimator of it is unbiased where two places
// tie. An interval comes from the question which true figures are compatible with the data: the two
// sets of values of the null hypothesis, one as small as the data allow, one as large.

#include <cstddef>
#include <vector>

namespace volcomp::host {

// max(upper) − min(lower). Where both are the same values: their range.
struct SpanValues {
  std::vector<double> upper, lower;

  [[nodiscard]] double figure() const;
};

// max(y).
struct PeakValues {
  std::vector<double> y;

  [[nodiscard]] double figure() const;
};

// Largest length of vectors of `components` numbers each, one after the other: of one number, the
// largest magnitude.
struct NormValues {
  std::size_t components = 1;
  std::vector<double> y;

  [[nodiscard]] double figure() const;
  [[nodiscard]] std::size_t places() const { return y.size() / components; }
};

// The values as they would be if the true figure were `figure` ≥ 0: the nearest ones that have it,
// and whatever lies within its standard uncertainty `u` of the edge on the edge: neighbours that
// may be equal extremes count as such (in the manner of D. W. K. Andrews and G. Soares,
// Econometrica 78, 2010). `u` of every value, of a vector one for all components.
[[nodiscard]] SpanValues nearest_with(const SpanValues& data, double figure,
                                      const std::vector<double>& u);
[[nodiscard]] PeakValues nearest_with(const PeakValues& data, double figure,
                                      const std::vector<double>& u);
[[nodiscard]] NormValues nearest_with(const NormValues& data, double figure,
                                      const std::vector<double>& u);

// The same with the extreme alone on the edge and the others shrunk towards their mean (James and
// Stein): what makes the figure of noisy data smallest.
[[nodiscard]] SpanValues lonely_with(const SpanValues& data, double figure,
                                     const std::vector<double>& u);
[[nodiscard]] PeakValues lonely_with(const PeakValues& data, double figure,
                                     const std::vector<double>& u);
[[nodiscard]] NormValues lonely_with(const NormValues& data, double figure,
                                     const std::vector<double>& u);

}  // namespace volcomp::host
