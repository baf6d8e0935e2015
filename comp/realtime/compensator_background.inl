// Background half of Compensator: settings, staging, hand-over.

#include <cmath>

namespace volcomp {

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::configure(const Settings& settings) {
  constexpr std::int32_t kMost = 4'194'303;          // what the rounding can represent
  constexpr std::int32_t kMostRate = 1'000'000'000;  // in effect unlimited
  Where where;
  for (std::size_t a = 0; a < kAxes; ++a) {
    const AxisLimits& l = settings.axis[a];
    where.index = static_cast<int>(a);
    where.axis = machine_.chain.letter[a];
    if (l.limit < 1 || l.limit > kMost) where.field = "limit";
    if (l.rate < 1 || l.rate > kMostRate) where.field = "rate";
    if (l.soft_rate < 1 || l.soft_rate > l.rate) where.field = "soft_rate";
    if (l.hysteresis < 0 || l.hysteresis > kMost) where.field = "hysteresis";
    if (l.max_step < 0) where.field = "max_step";
    if (where.field != nullptr) return refuse(Reason::bad_setting, where);
  }
  if (settings.ramp_ticks == 0) {
    where = {};
    where.field = "ramp_ticks";
    return refuse(Reason::bad_setting, where);
  }
  settings_ = settings;
  return {};
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::start_from(const std::array<std::int32_t, kAxes>& offsets) {
  for (std::size_t a = 0; a < kAxes; ++a) {
    axis_[a] = {};
    axis_[a].output = offsets[a];
  }
  begin_change();
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::stage(const MachineTables& tables, const Vec3& tool_point,
                                          std::uint32_t image_crc) {
  staged_ = false;
  FoldReport report;
  const auto spare = static_cast<std::size_t>(next_);
  const Status status = pending() ? refuse(Reason::not_staged)
                                  : fold_tables(tables, machine_.chain, tool_point,
                                                TableSetView(buffer_[spare]), report);
  if (!status.ok()) {
    if (diagnostics_.rejections < UINT32_MAX) ++diagnostics_.rejections;
    diagnostics_.last_rejection = status;
    return status;
  }
  buffer_[spare].image_crc = image_crc;
  report_ = report;
  staged_ = true;
  return {};
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::activate() {
  if (!staged_) return refuse(Reason::not_staged);
  staged_ = false;
  request_.store(Request::activate, std::memory_order_release);
  return {};
}

}  // namespace volcomp
