#include "hal/linux/open_status.hpp"

namespace volcomp::hal {

const char* sentence(OpenResult result) {
  switch (result) {
    case OpenResult::ok:
      return "open";
    case OpenResult::failed:
      return "the operating system refused";
    case OpenResult::no_can_in_kernel:
      return "this kernel has no CAN (modules can and can_raw)";
    case OpenResult::no_such_interface:
      return "no such interface";
    case OpenResult::not_a_can_interface:
      return "not a CAN interface";
    case OpenResult::interface_down:
      return "interface is down";
    case OpenResult::no_such_folder:
      return "there is no such folder";
    case OpenResult::not_a_pipe:
      return "what has the name of a pipe is none";
    case OpenResult::wrong_size:
      return "the file does not have the size of the store";
    case OpenResult::in_use:
      return "another process has it open";
  }
  return "unknown";
}

}  // namespace volcomp::hal
