#pragma once
// What the live page of a run shows: the machine of the last control period, what was counted so
// far, the last touches, how far the run is. Written by the run, read by the server beside it.

#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/sim/controller/tick_statistics.hpp"

namespace volcomp::sim {

class LiveFeed final : public MachineWatch {
 public:
  // `command` as the user has typed it; `transport`: where the compensation is done. The page shows
  // every `every`-th control period of a machine, and each in which its touch probe latches.
  LiveFeed(std::string command, std::string transport, std::uint32_t every = 1);

  // By the threads of the run. The feed must outlive the observers, whose counts are complete with
  // their end.
  [[nodiscard]] std::unique_ptr<MachineObserver> enter() override;
  void progress(double done, const std::string& what);
  // The run has come to its end with this report (host/report/document.hpp), or because of
  // something else. `offered`: the report can be had from the server.
  void ended(const nlohmann::json& document, bool offered);
  void failed(const std::string& why);

  // By any thread: docs/report.md names the members.
  [[nodiscard]] nlohmann::json state() const;

  // Only while no machine is observed.
  [[nodiscard]] const TickStatistics& ticks() const { return ticks_; }

 private:
  // Edges that latches of one machine have reported in the same period.
  struct Hit {
    std::uint64_t number = 0;  // of the last edge, from 1
    double time_s = 0.0;       // machine time of the run
    std::string letters;       // axes that latched
    MachineSnapshot machine;   // in that period
  };

  class Machine;

  void take(Machine& machine, const MachineSnapshot* now);
  void note_hits(Machine& machine, const MachineSnapshot& now);
  void measure_load(const Machine& machine, const MachineSnapshot& now);
  [[nodiscard]] nlohmann::json axes() const;
  [[nodiscard]] nlohmann::json bus() const;
  [[nodiscard]] nlohmann::json hits() const;

  std::string command_;
  std::string transport_;
  std::uint32_t every_;

  mutable std::mutex mutex_;  // of all below
  TickStatistics ticks_;
  MachineSnapshot last_;
  std::size_t last_machine_ = 0;  // its number, from 1
  std::deque<Hit> hits_;          // the newest first
  std::uint64_t hit_count_ = 0;
  BusState window_;        // where the load of now is measured from
  double load_now_ = 0.0;  // share of the last tenth of a second of machine time
  double done_ = 0.0;
  std::string doing_ = "starting";
  const char* phase_ = "running";  // "ended", "failed"
  nlohmann::json outcome_;         // of the run; null while it runs
};

}  // namespace volcomp::sim
