#pragma once
// Lets the tick interrupt preempt the background. The background works on the node with the tick
// locked out (hal/critical_section.hpp), in pieces that are short against the tick period. Long
// work runs inside a Preemptible scope:
//
//   const Preemptible preemptible(preemption_);
//   crc = crc32(image);                          // the tick runs as often as it falls due
//
// Such a scope must touch nothing the tick uses; node.hpp lists what it may touch.

namespace volcomp::node {

class Preemption {
 public:
  virtual void allow() = 0;   // a tick that is due runs before this returns
  virtual void forbid() = 0;  // no tick from here on
                              // Both are barriers for the compiler; allow() again inside a scope
                              // counts, so that the outermost one decides.

 protected:
  Preemption() = default;
  Preemption(const Preemption&) = default;
  Preemption& operator=(const Preemption&) = default;
  ~Preemption() = default;
};

// nullptr: there is only one context, nothing happens.
class Preemptible {
 public:
  explicit Preemptible(Preemption* preemption) : preemption_(preemption) {
    if (preemption_ != nullptr) preemption_->allow();
  }
  Preemptible(const Preemptible&) = delete;
  Preemptible& operator=(const Preemptible&) = delete;
  ~Preemptible() {
    if (preemption_ != nullptr) preemption_->forbid();
  }

 private:
  Preemption* preemption_;
};

}  // namespace volcomp::node
