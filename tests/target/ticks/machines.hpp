#pragma once
// The compensators with measured ticks, compiled once each (instances.cpp): beside the ready ones
// of the library those of the machines of the benchmarks.

#include "comp/tick/instances.hpp"
#include "tests/bench/machines.hpp"

namespace volcomp {

using GenericMachine = CompiledMachine<bench::kGeneric, RuntimeModel::second_order>;
using GrinderMachine = CompiledMachine<bench::kGrinder>;
using FiveAxisMachine = CompiledMachine<bench::kFiveAxis>;
using EightAxisMachine = LoadedMachine<kMaxAxes>;

extern template class Compensator<GenericMachine>;
extern template class Compensator<GrinderMachine>;
extern template class Compensator<FiveAxisMachine>;
extern template class Compensator<EightAxisMachine>;
extern template class Compensator<CompiledMachine<kXyfzMachine>, kDefaultKnots,
                                  OffsetLimiter<false>>;
extern template class Compensator<PositionMachine, kDefaultKnots, OffsetLimiter<false>>;
extern template class Compensator<OrientingMachine, kDefaultKnots, OffsetLimiter<false>>;
extern template class Compensator<GrinderMachine, kDefaultKnots, OffsetLimiter<false>>;
extern template class Compensator<FiveAxisMachine, kDefaultKnots, OffsetLimiter<false>>;

}  // namespace volcomp
