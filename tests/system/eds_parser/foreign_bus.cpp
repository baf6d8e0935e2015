// Three simulated drives of one data sheet, the compensation node as `volcomp setup` leaves it, and
// a place on the bus for a master that somebody else wrote (foreign_master_test.mjs).
//
//   foreign_bus PROFILE
//
// Standard input, a line each; time stands still between them:
//   F ID HEX     a frame of the master; 2 ms pass
//   R US         so many microseconds pass
//   C HEX ID HEX…   a cycle: SYNC with this counter (-: none), 0.3 ms later the other frames
//   E            asks for the offsets that the simulated controller of this project gets with the
//                same drives: by 50 units in each of 20 cycles away, and back
// Standard output: F ID HEX for every frame that the master hears; A WAY PERIOD COUNTER TARGET…, as
// the first line, and E OFFSET… in units of the drives; a dot ends each answer.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "firmware/node/node.hpp"
#include "host_sim/host/bus/drive_model.hpp"
#include "host_sim/host/bus/setup_plan.hpp"
#include "tests/system/bus_world.hpp"

namespace {

using namespace volcomp;

constexpr int kStep = 50;  // units of the drive
constexpr int kWay = 20;   // cycles
constexpr int kSettle = 1500;
constexpr std::uint64_t kAfterFrame_us = 2000;
constexpr std::uint64_t kSyncPhase_us = 300;

hal::CanFrame frame_of(const std::string& id, const std::string& bytes) {
  hal::CanFrame frame;
  frame.id = static_cast<std::uint16_t>(std::stoul(id, nullptr, 16));
  frame.size = static_cast<std::uint8_t>(bytes == "-" ? 0 : bytes.size() / 2);
  for (std::size_t i = 0; i < frame.size; ++i)
    frame.data.at(i) = static_cast<std::uint8_t>(std::stoul(bytes.substr(2 * i, 2), nullptr, 16));
  return frame;
}

class ForeignBus {
 public:
  explicit ForeignBus(const std::string& profile)
      : settings_(host::with_models(sim::bus_machine_settings(), {profile})),
        node_(settings_.node, nullptr),
        setup_(settings_.node) {
    for (const host::BusAxis& axis : settings_.axes)
      attach_drive(axis);
    bus_.attach(node_.device(), "node");
    node_.power_on(0);
    bus_.attach(*this, "setup");
    host::queue_plan(setup_, host::node_plan(settings_));
    setup_.write({0x2110, 1}, sim::bus_machine().image, "tables");
    setup_.write_value<std::uint8_t>({0x2111, 0}, 3, "activation");
    while (!setup_.idle())
      run(kAfterFrame_us);
    if (!setup_.failure().empty()) throw std::runtime_error(setup_.failure());
    master_ = &bus_.attach_served("master", {}, 256);
  }

  void send(std::istream& line) {
    std::string id;
    std::string bytes;
    line >> id >> bytes;
    static_cast<void>(master_->send(frame_of(id, bytes)));
    run(kAfterFrame_us);
  }
  void cycle(std::istream& line) {
    const std::uint64_t begin_ns = bus_.bus().now_ns();
    std::string id;
    std::string bytes;
    line >> bytes;
    static_cast<void>(master_->send(frame_of("80", bytes)));
    run(kSyncPhase_us);
    while (line >> id >> bytes)
      static_cast<void>(master_->send(frame_of(id, bytes)));
    bus_.run_until(begin_ns + 1000 * std::uint64_t{settings_.period_us});
  }
  void run(std::uint64_t us) { bus_.run_until(bus_.bus().now_ns() + 1000 * us); }
  void tell_frames() {
    hal::CanFrame frame;
    while (master_->receive(frame)) {
      std::string bytes;
      for (std::size_t i = 0; i < frame.size; ++i)
        bytes += fmt::format("{:02x}", frame.data.at(i));
      std::cout << fmt::format("F {:x} {}\n", frame.id, bytes);
    }
  }
  void tell_machine() {
    std::cout << fmt::format("A {} {} {}", static_cast<int>(settings_.axes[0].way),
                             settings_.period_us, host::sync_counter_overflow(settings_));
    for (const auto& drive : drives_)
      std::cout << " " << drive->demand();
    std::cout << "\n";
  }
  void tell_expected() const {
    sim::BusAxes axes(settings_, sim::bus_machine().image);
    axes.stand_at(host::pose_of(kPlace));
    axes.bring_up();
    const host::Targets begin = axes.target();
    for (int i = -kWay; i <= kWay + kSettle; ++i) {
      host::Targets target = begin;
      for (std::size_t a = 0; a < settings_.axes.size(); ++a)
        target[a] += std::int64_t{kStep} * std::max(kWay - std::abs(i), 0) *
                     settings_.axes[a].scale_numerator / settings_.axes[a].scale_denominator;
      axes.cycle(target);
    }
    const host::Offsets offsets = axes.offset();
    std::cout << "E";
    for (std::size_t a = 0; a < settings_.axes.size(); ++a)
      std::cout << " "
                << static_cast<double>(offsets[a]) * settings_.axes[a].scale_denominator /
                       settings_.axes[a].scale_numerator;
    std::cout << "\n";
  }

  // --- as canopen::exchange() wants it: who sets up the node
  void receive(const hal::CanFrame& frame, std::uint64_t now_us) { setup_.receive(frame, now_us); }
  void poll(std::uint64_t now_us) { setup_.poll(now_us); }
  [[nodiscard]] bool offer(hal::CanFrame& frame, std::uint64_t /*now_us*/) {
    return setup_.offer(frame);
  }
  void taken(std::uint64_t /*now_us*/) { setup_.taken(); }

 private:
  inline static const Vec3 kPlace{-250.0, -150.0, -200.0};

  void attach_drive(const host::BusAxis& axis) {
    const double nm = static_cast<double>(axis.scale_numerator) / axis.scale_denominator;
    sim::Cia402Drive::Settings s;
    s.node_id = axis.drive;
    s.period_s = 1e-6 * settings_.period_us;
    s.profile = std::make_shared<const sim::DriveProfile>(axis.model->eds());
    s.following_window = static_cast<std::uint32_t>(s.following_window / nm);
    s.deceleration = static_cast<std::uint32_t>(s.deceleration / nm);
    s.units.mm_per_unit = 1e-6 * nm;
    s.units.presliding /= nm;
    drives_.push_back(std::make_unique<sim::Cia402Drive>(s));
    sim::Cia402Drive& drive = *drives_.back();
    bus_.attach(drive, "drive");
    drive.stand_at(std::llround(1e6 * kPlace(axis.drive - 1) / nm));
    drive.power_on(0);
  }

  host::BusSettings settings_;
  sim::SimulatedBus bus_;
  node::Node node_;
  host::SdoChannel setup_;
  std::vector<std::unique_ptr<sim::Cia402Drive>> drives_;
  sim::SimulatedBus::Port* master_ = nullptr;
};

void serve(ForeignBus& bus) {
  bus.tell_machine();
  for (std::string text; std::cout << ".\n" << std::flush, std::getline(std::cin, text);) {
    std::istringstream line(text);
    char what = '\0';
    line >> what;
    if (what == 'F') bus.send(line);
    if (what == 'C') bus.cycle(line);
    if (what == 'R') {
      std::uint64_t us = 0;
      line >> us;
      bus.run(us);
    }
    if (what == 'E') bus.tell_expected();
    bus.tell_frames();
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    ForeignBus bus(argv[1]);
    serve(bus);
  } catch (const std::exception& e) {
    std::cerr << "foreign_bus: " << e.what() << "\n";
    return 1;
  }
  return 0;
}
