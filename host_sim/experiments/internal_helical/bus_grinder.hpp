#pragma once
// The grinder on a CAN bus: controller, drives with the axes of the grinder behind them, and a
// compensation node that watches the strokes, learns and adds what it has learned to 60B0h of C.

#include <memory>

#include "host_sim/experiments/internal_helical/grinder_control.hpp"
#include "host_sim/experiments/internal_helical/grinder_plant.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"

namespace volcomp::internal_helical {

// Axes X, Z and C of a machine; the node has tables without errors. Throws UserError where the
// machine has other axes, where C is not among the correcting ones, and for settings that the node
// would refuse.
[[nodiscard]] std::unique_ptr<sim::BusAxes> grinder_axes(const host::MachineFile& machine,
                                                         const host::WatchedStrokes& watched,
                                                         const sim::BusAxesFactory& make_axes);

class BusGrinder final : public GrinderControl {
 public:
  // `plant` must outlive it and stands at `standing`.
  BusGrinder(std::unique_ptr<sim::BusAxes> axes, const StrokeStep& standing, GrinderPlant& plant);

  // All of them throw UserError when the machine stops or the node refuses.
  void cycle(const StrokeStep& step) override;
  void learn() override;
  [[nodiscard]] MonitorView view() override;
  [[nodiscard]] LearnedTables tables() override;

  // The reason why the node adds no learned offset although it has tables; empty where it does.
  [[nodiscard]] std::string feed_trouble();

  // An object of the node; the machine rests until it is there. `most`: bytes it may have.
  [[nodiscard]] host::SdoChannel::Bytes read(canopen::ObjectId object, std::size_t most,
                                             const std::string& what);
  template <class T>
  [[nodiscard]] T read(const canopen::object_lines::Handle<T>& object) {
    return host::value_of<T>(read(object.id(), object.bytes(), object.name));
  }
  [[nodiscard]] sim::BusAxes& axes() { return *axes_; }

 private:
  // 2516h: means by node, or by slot.
  [[nodiscard]] std::vector<double> read_means(std::size_t table, std::size_t most);
  void rest_until_answered();

  std::unique_ptr<sim::BusAxes> axes_;
  StrokeStep last_;
};

}  // namespace volcomp::internal_helical
