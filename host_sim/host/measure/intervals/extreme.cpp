#include "host_sim/host/measure/intervals/extreme.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace volcomp::host {
namespace {

double largest(const std::vector<double>& y) { return *std::max_element(y.begin(), y.end()); }
double least(const std::vector<double>& y) { return *std::min_element(y.begin(), y.end()); }

std::size_t place_of_largest(const std::vector<double>& y) {
  return static_cast<std::size_t>(std::max_element(y.begin(), y.end()) - y.begin());
}
std::size_t place_of_least(const std::vector<double>& y) {
  return static_cast<std::size_t>(std::min_element(y.begin(), y.end()) - y.begin());
}

double sum_of_squares(const std::vector<double>& y) {
  return std::inner_product(y.begin(), y.end(), y.begin(), 0.0);
}

// Towards the mean, after James and Stein.
std::vector<double> shrunk(std::vector<double> y, const std::vector<double>& u) {
  const auto n = static_cast<double>(y.size());
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / n;
  for (double& value : y)
    value -= mean;
  const double squares = sum_of_squares(y);
  const double noise = (n - 1.0) * sum_of_squares(u) / n;
  const double kept = squares > 0.0 ? 1.0 - std::min(1.0, noise / squares) : 0.0;
  for (double& value : y)
    value = mean + kept * value;
  return y;
}

// The lower edge a for which as much is cut off above a + figure as below a.
double lower_edge(const SpanValues& data, double figure) {
  const double range = data.figure();
  const double bottom = least(data.lower);
  if (figure >= range) return bottom - 0.5 * (figure - range);
  // Σ(t − a − θ)₊ − Σ(a − b)₊ falls with a, in straight pieces between these places.
  std::vector<double> corner = data.lower;
  for (const double t : data.upper)
    corner.push_back(t - figure);
  std::sort(corner.begin(), corner.end());
  const auto excess = [&](double a) {
    double sum = 0.0;
    for (const double t : data.upper)
      sum += std::max(t - a - figure, 0.0);
    for (const double b : data.lower)
      sum -= std::max(a - b, 0.0);
    return sum;
  };
  const auto after =
      std::partition_point(corner.begin(), corner.end(), [&](double a) { return excess(a) > 0.0; });
  if (after == corner.begin()) return corner.front();
  if (after == corner.end()) return corner.back();
  const double low = *(after - 1);
  const double high = *after;
  const double at_low = excess(low);
  const double at_high = excess(high);
  return low + (high - low) * at_low / (at_low - at_high);
}

std::vector<double> lengths(const NormValues& data) {
  std::vector<double> length(data.places());
  for (std::size_t p = 0; p < length.size(); ++p) {
    double squares = 0.0;
    for (std::size_t i = 0; i < data.components; ++i)
      squares += std::pow(data.y[data.components * p + i], 2);
    length[p] = std::sqrt(squares);
  }
  return length;
}

void scale(NormValues& data, std::size_t place, double by) {
  for (std::size_t i = 0; i < data.components; ++i)
    data.y[data.components * place + i] *= by;
}

// A vector of no length has no direction and stays.
void set_length(NormValues& data, std::size_t place, double now, double wanted) {
  if (now > 0.0) scale(data, place, wanted / now);
}

}  // namespace

double SpanValues::figure() const { return largest(upper) - least(lower); }
double PeakValues::figure() const { return largest(y); }
double NormValues::figure() const { return largest(lengths(*this)); }

SpanValues nearest_with(const SpanValues& data, double figure, const std::vector<double>& u) {
  const double low = lower_edge(data, figure);
  const double high = low + figure;
  SpanValues out = data;
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (out.upper[i] >= high - u[i]) out.upper[i] = high;
    if (out.lower[i] <= low + u[i]) out.lower[i] = low;
  }
  out.upper[place_of_largest(data.upper)] = high;
  out.lower[place_of_least(data.lower)] = low;
  return out;
}

PeakValues nearest_with(const PeakValues& data, double figure, const std::vector<double>& u) {
  PeakValues out = data;
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (out.y[i] >= figure - u[i]) out.y[i] = figure;
  }
  out.y[place_of_largest(data.y)] = figure;
  return out;
}

NormValues nearest_with(const NormValues& data, double figure, const std::vector<double>& u) {
  const std::vector<double> length = lengths(data);
  const std::size_t edge = place_of_largest(length);
  NormValues out = data;
  for (std::size_t p = 0; p < length.size(); ++p) {
    if (p == edge || length[p] >= figure - u[p]) set_length(out, p, length[p], figure);
  }
  return out;
}

SpanValues lonely_with(const SpanValues& data, double figure, const std::vector<double>& u) {
  const double low = lower_edge(data, figure);
  const double high = low + figure;
  SpanValues out{shrunk(data.upper, u), shrunk(data.lower, u)};
  for (double& t : out.upper)
    t = std::min(t, high);
  for (double& b : out.lower)
    b = std::max(b, low);
  out.upper[place_of_largest(data.upper)] = high;
  out.lower[place_of_least(data.lower)] = low;
  return out;
}

PeakValues lonely_with(const PeakValues& data, double figure, const std::vector<double>& u) {
  PeakValues out{shrunk(data.y, u)};
  for (double& y : out.y)
    y = std::min(y, figure);
  out.y[place_of_largest(data.y)] = figure;
  return out;
}

NormValues lonely_with(const NormValues& data, double figure, const std::vector<double>& u) {
  const std::vector<double> length = lengths(data);
  const double squares = sum_of_squares(data.y);
  const double noise = static_cast<double>(data.components) * sum_of_squares(u);
  const double kept = squares > 0.0 ? 1.0 - std::min(1.0, noise / squares) : 0.0;
  const std::size_t edge = place_of_largest(length);
  NormValues out = data;
  for (std::size_t p = 0; p < length.size(); ++p) {
    const bool cut = p == edge || kept * length[p] > figure;
    cut ? set_length(out, p, length[p], figure) : scale(out, p, kept);
  }
  return out;
}

}  // namespace volcomp::host
