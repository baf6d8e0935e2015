#pragma once
// A grinder on a bench: X, Z and C played by hand while the wheel goes up and down through slots.
// C leads or lags by what a test sets, and takes the offset of the node at the next SYNC.

#include <functional>

#include "comp/core/bytes.hpp"
#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {

// The paper's gear (docs/papers/internal-helical.md): 1/p in rad/mm, r_b cos β_b in mm.
inline constexpr double kTurnPerMm = 1.0 / 305.2;
inline constexpr double kLever = 74.236;
inline constexpr double kWireStep = 2.0 * kPi / 2147483648.0;  // of the drive of C, rad

// X and C under the gear, Z under the wheel; C corrects. No errors.
[[nodiscard]] MachineTables stroke_tables();

class StrokeBench {
 public:
  static constexpr std::int32_t kHalfFace_nm = 5'000'000;
  static constexpr std::int32_t kStep_nm = 100'000;  // per cycle
  static constexpr std::int32_t kFeed_nm_per_s = 50'000'000;
  static constexpr std::uint16_t kSlots = 3;

  // Where an axis stands against its command.
  struct Errors {
    double z_mm = 0.0;
    double c_rad = 0.0;
  };
  using ErrorsAt = std::function<Errors(std::uint16_t slot, bool up, double z_mm)>;

  explicit StrokeBench(Storage* storage = nullptr) : bench(storage) {}

  // Everything a grinder needs, outside OPERATIONAL.
  void configure();
  void start();
  // Up and down through every slot, with the axes wrong by `errors`; ends at rest outside the face.
  void grind(const ErrorsAt& errors, int rounds = 1);
  [[nodiscard]] canopen::AbortCode learn(LearnCommand command) {
    return bench.set<std::uint8_t>(0x2520, 1, static_cast<std::uint8_t>(command));
  }
  // The offset C holds, rad.
  [[nodiscard]] double offset() const;
  [[nodiscard]] std::array<float, 3> floats(std::uint16_t index);
  [[nodiscard]] double real(std::uint16_t index, std::uint8_t sub);
  // 2516h and 2526h.
  [[nodiscard]] std::vector<float> means(std::uint8_t table);
  [[nodiscard]] Bytes image();

  NodeBench bench;
  std::int32_t feed_nm_per_s = kFeed_nm_per_s;
  // What the node does not get.
  std::function<bool(std::uint16_t slot, bool up, double z_mm)> process_state_lost;
  // Largest and least offset C held in the face in the last round, rad.
  double most = 0.0;
  double least = 0.0;
  // Largest change of the step of the offset of C, from one cycle to the next, drive units.
  std::int32_t largest_change = 0;

 private:
  void stroke(std::uint16_t slot, bool up, const ErrorsAt& errors);
  // The place of a target, reached at the next SYNC.
  void cycle(std::int32_t z_nm, std::uint16_t slot, bool up, bool end, const ErrorsAt& errors);

  struct Commanded {
    std::int32_t z = -6'000'000;
    std::int32_t c = 0;
    std::uint16_t slot = 0;
    bool up = true;
    bool in_face = false;
  };
  void note_step();

  Commanded now_{};  // in force
  std::int32_t held_ = 0;
  std::int32_t step_ = 0;
};

}  // namespace volcomp::node
