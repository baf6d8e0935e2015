#pragma once
// The search for the most expensive tick, machine by machine: the same on a board, which counts
// instructions, and on a computer, which looks at the digests only.

#include <array>
#include <cstdint>
#include <memory>

#include "tests/target/ticks/adversary.hpp"
#include "tests/target/ticks/worst_machines.hpp"

namespace volcomp::target {

// Equal on x86-64 with g++ 12, on Cortex-M7 and on Cortex-M4F; loaded and compiled in alike.
struct Digests {
  SearchDigest unbounded;  // accelerations have no limit
  SearchDigest bounded;

  friend bool operator==(const Digests& a, const Digests& b) {
    return a.unbounded == b.unbounded && a.bounded == b.bounded;
  }
};

struct WorstMachine {
  const char* name = "";
  Digests digests;
};

struct Searched {
  WorstCost cost;
  Digests digests;
  std::uint32_t seen = 0;  // status bits
};

// Calls visit(machine, unit, description) for every machine.
template <class Visit>
void visit_worst_machines(const Visit& visit) {
  const auto compiled = [&visit](auto machine, const WorstMachine& worst,
                                 const MachineDescription& description) {
    visit(worst, std::make_unique<Compensator<decltype(machine)>>(), description);
  };
  const auto loaded = [&visit](auto machine, const WorstMachine& worst,
                               const MachineDescription& description) {
    machine.chain = make_runtime_chain(description);
    visit(worst, std::make_unique<Compensator<decltype(machine)>>(machine), description);
  };
  // Without a bound on acceleration compiled in.
  const auto rate_alone = [&visit](auto machine, const WorstMachine& worst,
                                   const MachineDescription& description) {
    using Machine = decltype(machine);
    if constexpr (!Machine::kCompiledIn) machine.chain = make_runtime_chain(description);
    visit(worst,
          std::make_unique<Compensator<Machine, kDefaultKnots, OffsetLimiter<false>>>(machine),
          description);
  };
  constexpr Digests kXyfz{{12'492'387'717'051'557'654U, 6'024'835'773'910'373'722U},
                          {1'549'747'516'163'213'970U, 14'678'649'380'055'548'367U}};
  constexpr Digests kGrinder{{9'243'315'373'203'015'057U, 17'766'546'694'678'514'589U},
                             {6'992'581'952'274'221'436U, 13'837'417'758'869'793'121U}};
  constexpr Digests kFiveAxis{{5'490'987'753'475'532'525U, 4'616'295'232'304'530'128U},
                              {13'100'549'362'765'608'777U, 11'415'935'250'694'918'931U}};
  constexpr Digests kOrienting{{528'068'783'793'407'069U, 16'110'293'030'151'217'396U},
                               {1'170'362'861'166'124'664U, 13'679'126'773'439'381'970U}};
  constexpr Digests kAskew{{12'357'780'227'284'175'240U, 18'289'089'341'562'553'116U},
                           {8'107'320'614'876'969'506U, 2'347'377'835'024'409'937U}};
  constexpr Digests kFixed{{1'728'658'799'683'911'960U, 1'977'383'294'907'633'050U},
                           {15'315'331'135'047'416'063U, 16'252'548'912'905'423'707U}};
  constexpr Digests kEight{{2'577'564'833'097'721'151U, 11'352'251'374'909'030'949U},
                           {2'602'771'355'137'810'183U, 8'099'844'436'431'124'885U}};
  // As with a bound that is none.
  constexpr Digests kXyfzRate{kXyfz.unbounded,
                              {17'539'624'782'413'749'542U, 8'576'901'407'188'375'798U}};
  constexpr Digests kGrinderRate{kGrinder.unbounded,
                                 {1'077'075'586'422'957'359U, 15'467'943'141'947'856'434U}};
  constexpr Digests kOrientingRate{kOrienting.unbounded,
                                   {5'042'287'437'074'072'760U, 15'353'279'116'068'709'464U}};
  constexpr Digests kFiveAxisRate{kFiveAxis.unbounded,
                                  {2'808'484'671'819'803'188U, 3'045'634'179'688'669'048U}};
  compiled(CompiledMachine<kXyfzMachine>{}, {"xyfz_compiled", kXyfz}, kXyfzMachine);
  loaded(PositionMachine{}, {"xyfz_loaded", kXyfz}, kXyfzMachine);
  compiled(GrinderMachine{}, {"xyb_a_compiled", kGrinder}, bench::kGrinder);
  loaded(PositionMachine{}, {"xyb_a_loaded", kGrinder}, bench::kGrinder);
  compiled(FiveAxisMachine{}, {"five_axis_compiled", kFiveAxis}, bench::kFiveAxis);
  loaded(PositionMachine{}, {"five_axis_loaded", kFiveAxis}, bench::kFiveAxis);
  loaded(OrientingMachine{}, {"five_axis_orienting", kOrienting}, orienting_five_axis());
  loaded(PositionMachine{}, {"five_axis_askew", kAskew}, askew_five_axis());
  loaded(PositionMachine{}, {"five_axis_fixed", kFixed}, askew_five_axis_with_fixed_bodies());
  loaded(EightAxisMachine{}, {"eight_axis", kEight}, eight_axis());
  rate_alone(CompiledMachine<kXyfzMachine>{}, {"xyfz_compiled_rate", kXyfzRate}, kXyfzMachine);
  rate_alone(PositionMachine{}, {"xyfz_loaded_rate", kXyfzRate}, kXyfzMachine);
  rate_alone(GrinderMachine{}, {"xyb_a_compiled_rate", kGrinderRate}, bench::kGrinder);
  rate_alone(PositionMachine{}, {"xyb_a_loaded_rate", kGrinderRate}, bench::kGrinder);
  rate_alone(FiveAxisMachine{}, {"five_axis_compiled_rate", kFiveAxisRate}, bench::kFiveAxis);
  rate_alone(PositionMachine{}, {"five_axis_loaded_rate", kFiveAxisRate}, bench::kFiveAxis);
  rate_alone(OrientingMachine{}, {"five_axis_orienting_rate", kOrientingRate},
             orienting_five_axis());
}

template <class Machine, std::size_t Knots, class Limiter>
constexpr bool accelerates(const Compensator<Machine, Knots, Limiter>& /*unit*/) {
  return Limiter::kAccelerates;
}

template <class Unit, class Meter>
Searched look_for_the_worst(Unit& unit, const MachineDescription& machine, Meter& meter) {
  const TwoTables tables = make_worst_tables(machine);
  Adversary<Unit, Meter> adversary(unit, {tables.one.get(), tables.other.get()}, meter);
  const SearchDigest unbounded = adversary.search(Accelerations::none);
  // A unit that knows no such bound takes none: it is searched as long, without.
  const SearchDigest bounded =
      adversary.search(accelerates(unit) ? Accelerations::limited : Accelerations::none);
  return {adversary.cost(), {unbounded, bounded}, adversary.seen()};
}

}  // namespace volcomp::target
