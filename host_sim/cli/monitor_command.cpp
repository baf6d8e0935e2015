// volcomp monitor

#include <memory>
#include <optional>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/bus_monitor.hpp"
#include "host_sim/host/bus/can_log.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"
#include "host_sim/host/io/csv_cells.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

struct MonitorArguments {
  std::string link;
  std::string log;
  std::string machine;
  std::optional<int> node_id;
  double rate_hz = 1.0;
  bool once = false;
  bool json = false;
};

// The machine file, or drives 1 to 5 whose axes are not known: letters after their order.
host::BusSettings settings_of(const MonitorArguments& a) {
  host::BusSettings settings;
  if (!a.machine.empty()) {
    settings = host::bus_settings(host::read_machine_file(a.machine), 1000.0);
  } else {
    for (const char letter : {'X', 'Y', 'Z', 'A', 'B'}) {
      host::BusAxis axis;
      axis.letter = letter;
      axis.drive = static_cast<std::uint8_t>(settings.axes.size() + 1);
      axis.rotary = letter == 'A' || letter == 'B';
      settings.axes.push_back(axis);
    }
  }
  if (a.node_id) settings.node = static_cast<std::uint8_t>(*a.node_id);
  return settings;
}

class Watch {
 public:
  explicit Watch(const MonitorArguments& arguments)
      : arguments_(arguments),
        monitor_(settings_of(arguments)),
        period_us_(static_cast<std::uint64_t>(1e6 / arguments.rate_hz)) {}

  // Time without frames counts, too. False: the one report of `once` is printed.
  bool until(std::uint64_t time_us) {
    if (next_us_ == 0) next_us_ = time_us + period_us_;
    while (time_us >= next_us_ && !whole_log()) {
      print(next_us_);
      if (arguments_.once) return false;
      next_us_ += period_us_;
      // A gap of hours in a log gives one report.
      if (time_us > next_us_ + kMostSilent * period_us_) next_us_ = time_us;
    }
    last_us_ = time_us;
    return true;
  }
  void take(std::uint64_t time_us, const hal::CanFrame& frame) {
    monitor_.take(time_us, frame);
    unprinted_ = true;
  }
  // The rest.
  void end() {
    if (unprinted_) print(last_us_);
  }

 private:
  static constexpr std::uint64_t kMostSilent = 10;

  // Once over a log is all of it.
  [[nodiscard]] bool whole_log() const { return arguments_.once && !arguments_.log.empty(); }

  void print(std::uint64_t now_us) {
    const host::BusSnapshot seen = monitor_.snapshot(now_us);
    fmt::print("{}", arguments_.json ? host::to_json(seen).dump() + "\n" : host::describe(seen));
    finish_standard_output();
    unprinted_ = false;
  }

  const MonitorArguments& arguments_;
  host::BusMonitor monitor_;
  std::uint64_t period_us_;
  std::uint64_t next_us_ = 0;
  std::uint64_t last_us_ = 0;
  bool unprinted_ = false;
};

void watch_log(std::istream& stream, const std::string& name, Watch& watch,
               const host::Interruption& interruption) {
  host::CsvLines lines(stream, name);
  std::string line;
  host::SteadyTime steady;
  bool any = false;
  while (lines.any(line)) {
    interruption.check();
    const std::optional<host::LoggedFrame> logged = host::parse_log_line(line, name, lines.line());
    if (!logged) continue;
    any = true;
    const std::uint64_t time_us = steady.of(*logged);
    if (!watch.until(time_us)) return;
    watch.take(time_us, logged->frame);
  }
  if (!any) throw host::UserError(fmt::format("{}: holds no frames", name));
}

void watch_bus(const std::string& name, Watch& watch, const host::Interruption& interruption) {
  constexpr std::uint32_t kWait_us = 20'000;
  const std::unique_ptr<host::FrameLink> link = host::open_frame_link(name);
  while (watch.until(link->now_us())) {
    interruption.check();
    link->wait(kWait_us);
    hal::CanFrame frame;
    while (link->receive(frame))
      watch.take(link->now_us(), frame);
  }
}

int monitor(const MonitorArguments& a) {
  if (a.link.empty() == a.log.empty())
    throw host::UserError("monitor needs --can or --log, one of them");
  if (a.link == "loopback")
    throw host::UserError(
        "loopback is a bus inside volcomp run; there is nothing to be heard of it");
  Watch watch(a);
  const host::Interruption interruption;
  try {
    if (a.log.empty()) {
      watch_bus(a.link, watch, interruption);
    } else {
      host::InputFile log(a.log);
      watch_log(log.stream(), log.name(), watch, interruption);
    }
  } catch (const host::Interrupted&) {  // that is how it ends
  }
  watch.end();
  return 0;
}

}  // namespace

void add_monitor_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "monitor", "Listen to the bus of a machine: states, positions, offsets, load, errors");
  auto a = std::make_shared<MonitorArguments>();
  command->add_option("--can", a->link, fmt::format("Bus to listen to: {}", host::kLinkForms));
  command->add_option("--log", a->log, "Log of candump -L instead (-: standard input)");
  command->add_option("--machine", a->machine,
                      "Machine file (TOML): letters and kinds of its axes (default: drives 1 to 5 "
                      "are X, Y, Z, linear, and A, B, rotary)");
  command
      ->add_option("--node-id", a->node_id,
                   "CANopen node id of the compensation node (default: that of the machine file, "
                   "or 32)")
      ->check(CLI::Range(1, 127));
  command->add_option("--rate-hz", a->rate_hz, "How often to print, 1/s")
      ->check(number_between(0.01, 100.0))
      ->capture_default_str();
  command->add_flag("--once", a->once, "Print once, after one period or at the end of the log");
  command->add_flag("--json", a->json, "One JSON object per line");
  command->callback([a, &code] { code = monitor(*a); });
}

}  // namespace volcomp::cli
