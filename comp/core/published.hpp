#pragma once
// A number that one context writes and another reads at the same time: a counter of an interrupt
// that the background shows. A reader gets a value that was written, never half of it. On
// processors that load it in one instruction it costs what a plain variable does; the one that
// writes it reads it as such. Atomic accesses of plain variables (GCC and Clang builtins), since
// objects with std::atomic in them cannot be copied.

namespace volcomp {

template <class T>
class Published {
 public:
  constexpr Published() = default;
  constexpr Published(T value) : value_(value) {}  // NOLINT(google-explicit-constructor)

  // For the context that writes.
  [[nodiscard]] const T& own() const { return value_; }
  void set(T value) { __atomic_store(&value_, &value, __ATOMIC_RELAXED); }
  // Whatever was written before it is seen by a reader that acquires.
  void release(T value) { __atomic_store(&value_, &value, __ATOMIC_RELEASE); }

  // For any context.
  [[nodiscard]] T get() const {
    T value{};
    __atomic_load(&value_, &value, __ATOMIC_RELAXED);
    return value;
  }
  [[nodiscard]] T acquire() const {
    T value{};
    __atomic_load(&value_, &value, __ATOMIC_ACQUIRE);
    return value;
  }

 private:
  T value_{};
};

}  // namespace volcomp
