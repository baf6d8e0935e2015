#include "tests/firmware/node/single_step.hpp"

#include <csignal>
#include <stdexcept>

#include <ucontext.h>

#ifndef __x86_64__
#error "written for the trap flag of x86-64"
#endif

namespace volcomp::test {
namespace {

constexpr greg_t kTrapFlag = 0x100;

struct Stepping {
  SingleStep::Between between = nullptr;
  void* context = nullptr;
  std::uint64_t done = 0;
  volatile bool wanted = false;
};
Stepping current;

// After a breakpoint, which starts stepping, or after a stepped instruction. The kernel clears the
// flag for the handler and restores it with the interrupted context.
void on_trap(int /*signal*/, siginfo_t* /*info*/, void* interrupted) {
  greg_t& flags = static_cast<ucontext_t*>(interrupted)->uc_mcontext.gregs[REG_EFL];
  const bool stepped = (flags & kTrapFlag) != 0;
  if (stepped && current.wanted) current.wanted = current.between(current.context, ++current.done);
  if (current.wanted) {
    flags |= kTrapFlag;
  } else {
    flags &= ~kTrapFlag;
  }
}

class TrapHandler {
 public:
  TrapHandler() {
    struct sigaction action = {};
    action.sa_sigaction = on_trap;
    action.sa_flags = SA_SIGINFO;
    if (sigaction(SIGTRAP, &action, &before_) != 0) throw std::runtime_error("no signal handler");
  }
  TrapHandler(const TrapHandler&) = delete;
  TrapHandler& operator=(const TrapHandler&) = delete;
  ~TrapHandler() { static_cast<void>(sigaction(SIGTRAP, &before_, nullptr)); }

 private:
  struct sigaction before_ = {};
};

}  // namespace

void SingleStep::resume() {
  current.wanted = true;
  asm volatile("int3" ::: "memory");
}

void SingleStep::pause() {
  current.wanted = false;
  asm volatile("nop" ::: "memory");  // the last trap
}

std::uint64_t SingleStep::run(void (*work)(void* context), Between between, void* context) {
  const TrapHandler handler;
  current = {};
  current.between = between;
  current.context = context;
  resume();
  work(context);
  pause();
  return current.done;
}

}  // namespace volcomp::test
