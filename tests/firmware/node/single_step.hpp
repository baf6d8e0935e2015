#pragma once
// Real code stopped after every single machine instruction, as an interrupt may stop it: the trap
// flag of x86-64 and a signal handler (Intel SDM, volume 3, section 18.3.1.4). Nothing in the code
// under test is changed for it; it is the code of the build that is stepped through.

#include <cstdint>

namespace volcomp::test {

class SingleStep {
 public:
  // Called after an instruction with the number of those done, 1, 2, …; false ends the stepping,
  // the work goes on without. Runs in a signal handler: no heap, no assertions of the test
  // framework.
  using Between = bool (*)(void* context, std::uint64_t done);

  // Runs work(context). Returns how many instructions were stepped through. Not nested, one thread.
  static std::uint64_t run(void (*work)(void* context), Between between, void* context);

  // The same with objects that can be called.
  template <class Work, class Call>
  static std::uint64_t through(Work&& work, Call&& call) {
    struct Both {
      Work& work;
      Call& call;
    } both{work, call};
    return run([](void* c) { static_cast<Both*>(c)->work(); },
               [](void* c, std::uint64_t done) { return static_cast<Both*>(c)->call(done); },
               &both);
  }

  // For work that steps only part of itself: from within it, on and off again.
  static void resume();
  static void pause();
};

}  // namespace volcomp::test
