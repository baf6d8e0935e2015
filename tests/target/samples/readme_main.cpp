// The sample of README.md with what it leaves to its reader: the port and a main that ticks.

#include <cstdint>

#include "comp/tick/tick_types.hpp"
#include "firmware/boards/mps2/exit_code.hpp"

struct MyAxisPort {
  static void sample(volcomp::TickInput<3>& in) noexcept { in = {}; }
  static void apply(const volcomp::TickOutput<3>& /*out*/) noexcept {}
};

#include "readme_sample.inl"

int main() {
  const volcomp::XyfzCompensator::Output& out = servo_loop().last_output();
  for (std::uint32_t period = 0; period < 3; ++period)
    servo_loop().on_servo_interrupt();
  const bool ticked = compensator().diagnostics().ticks == 3 && out.status[0] != 0;
  return ticked ? volcomp::boards::kFine : volcomp::boards::kCheckFailed;
}
