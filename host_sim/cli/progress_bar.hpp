#pragma once
// One line on a terminal; prints nothing when the output goes elsewhere.

#include <unistd.h>

#include <cstdio>
#include <string>

#include <fmt/format.h>

namespace volcomp::cli {

class ProgressBar {
 public:
  void show(double done, const std::string& what) {
    if (!terminal_) return;
    constexpr int kWidth = 30;
    const int filled = static_cast<int>(done * kWidth);
    fmt::print(stderr, "\r\x1b[K[{:=<{}}{: <{}}] {:3.0f} % {}", "", filled, "", kWidth - filled,
               100.0 * done, what);
    static_cast<void>(std::fflush(stderr));
    shown_ = true;
  }
  ~ProgressBar() {
    if (shown_) static_cast<void>(std::fputs("\r\x1b[K", stderr));
  }
  ProgressBar() = default;
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  bool shown_ = false;
};

}  // namespace volcomp::cli
