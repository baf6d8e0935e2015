#include "tests/cases/tick_case.hpp"

#include "comp/core/units.hpp"
#include "comp/tables/image.hpp"

namespace volcomp::cases {

std::unique_ptr<MachineTables> machine_tables(const XyfzCase& c) {
  auto tables = std::make_unique<MachineTables>();
  tables->machine = c.model.chain.description();
  tables->directions = c.model.directions;
  for (std::size_t a = 0; a < 3; ++a) {
    require(quantise(c.internal[a], c.model.chain.axis(a), kDefaultKnots, tables->axis[a]));
  }
  return tables;
}

TickCase::TickCase(const XyfzCase& c, const TickLimits& limits) {
  const auto tables = machine_tables(c);
  std::vector<std::uint8_t> image(image_size(*tables));
  std::size_t written = 0;
  require(encode_image(*tables, image, written));
  const auto loaded = std::make_unique<MachineTables>();
  require(decode_image({image.data(), written}, kDefaultKnots, *loaded));

  compensator_ =
      std::make_unique<LoadedCompensator>(LoadedMachine<5>{make_runtime_chain(loaded->machine)});
  LoadedCompensator::Settings settings;
  for (AxisLimits& l : settings.axis) {
    l.limit = static_cast<std::int32_t>(to_nm(limits.limit_mm));
    l.rate = l.soft_rate = static_cast<std::int32_t>(to_nm(limits.rate_mm));
  }
  settings.source = PositionSource::actual;
  settings.ramp_ticks = 1;
  require(compensator_->configure(settings));
  std::array<std::int32_t, 5> start{};
  for (std::size_t a = 0; a < 3; ++a)
    start[a] = static_cast<std::int32_t>(to_nm(limits.start_mm[a]));
  require(compensator_->start_from(start));
  require(compensator_->stage(*loaded, c.model.tool_point, 0));
  require(compensator_->activate());
}

TickOutput<5> TickCase::run(const TickInput<5>& input) {
  TickOutput<5> out;
  compensator_->tick(input, out);
  return out;
}

}  // namespace volcomp::cases
