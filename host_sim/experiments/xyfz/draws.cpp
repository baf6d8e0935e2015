#include "host_sim/experiments/xyfz/draws.hpp"

#include <algorithm>

#include "comp/metrology/tables/diagonals.hpp"

namespace volcomp::xyfz {

double DrawResult::rate(std::size_t model) const {
  return improvement_percent(raw_um, residual_um.at(model));
}

double quantile(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  const double place = fraction * static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  const double next = i + 1 < values.size() ? values[i + 1] : values[i];
  return values[i] + (place - static_cast<double>(i)) * (next - values[i]);
}

double rate_quantile(const std::vector<DrawResult>& draws, std::size_t model, double fraction) {
  std::vector<double> rates;
  rates.reserve(draws.size());
  for (const DrawResult& d : draws)
    rates.push_back(d.rate(model));
  return quantile(std::move(rates), fraction);
}

double share_reaching(const std::vector<DrawResult>& draws, std::size_t model, double wanted) {
  const auto reached = std::count_if(draws.begin(), draws.end(),
                                     [&](const DrawResult& d) { return d.rate(model) >= wanted; });
  return static_cast<double>(reached) / static_cast<double>(draws.size());
}

}  // namespace volcomp::xyfz
