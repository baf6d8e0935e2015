#pragma once
// A drive whose motor has an end: it follows targets with speed and acceleration fed forward and a
// critically damped position loop, but accelerates by no more than it can. What it is asked for
// beyond that becomes following error.
//
// Between two targets the acceleration is constant, so that the motion is exact for any period.

namespace volcomp::sim {

class AcceleratingDrive {
 public:
  struct Settings {
    double period_s = 125e-6;     // between two targets, > 0
    double loop_hz = 40.0;        // natural frequency of the position loop, > 0
    double acceleration = 2.2e3;  // most that it can, mm/s², > 0
  };

  // Moves at `speed` (mm/s), as targets that change by `speed` times the period.
  AcceleratingDrive(const Settings& settings, double position_mm, double speed);

  // One period: `target_mm` is where the axis is to be at its end.
  void follow(double target_mm);

  [[nodiscard]] double position_mm() const { return position_; }
  // Latest target − position.
  [[nodiscard]] double following_error_mm() const { return target_ - position_; }
  // The latest period asked for more acceleration than there is.
  [[nodiscard]] bool saturated() const { return saturated_; }

 private:
  Settings settings_;
  double loop_;      // rad/s
  double position_;  // mm
  double speed_;     // mm/s
  double target_;    // latest
  double before_;    // the one before
  bool saturated_ = false;
};

}  // namespace volcomp::sim
