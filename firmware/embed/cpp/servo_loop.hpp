#pragma once
// The integrated form: the compensation inside the motion controller, one call per servo interrupt.

#include "firmware/embed/cpp/axis_port.hpp"

namespace volcomp {

template <class Compensator, class AxisPort>
class ServoLoop {
  static_assert(hal::IsAxisPort<AxisPort, Compensator::kAxes>::value,
                "see firmware/embed/cpp/axis_port.hpp");

 public:
  // Both must outlive the loop.
  ServoLoop(Compensator& compensator, AxisPort& port) : compensator_(compensator), port_(port) {}

  // From the servo interrupt, after the interpolator has set its targets and before the position
  // controllers run.
  void on_servo_interrupt() {
    port_.sample(input_);
    compensator_.tick(input_, output_);
    port_.apply(output_);
  }

  [[nodiscard]] const typename Compensator::Output& last_output() const { return output_; }

 private:
  Compensator& compensator_;
  AxisPort& port_;
  typename Compensator::Input input_{};
  typename Compensator::Output output_{};
};

}  // namespace volcomp
