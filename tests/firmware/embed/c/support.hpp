#pragma once
// A compensator behind volcomp.h, beside the L300G with random tables as an image.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "comp/tables/image.hpp"
#include "firmware/embed/c/volcomp.h"
#include "tests/oracle/probing_l300g.hpp"

namespace volcomp::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes encode(const MachineTables& tables) {
  Bytes bytes(image_size(tables));
  std::size_t written = 0;
  EXPECT_TRUE(encode_image(tables, bytes, written).ok());
  return bytes;
}

inline MachineTables random_l300g(std::uint64_t seed) {
  Random random(seed);
  return probing_tables(4e3, 7e-5, random);
}

// The reason by its name, with the field where there is one.
inline std::string text(const volcomp_status& s) {
  const std::string code = volcomp_code(s.reason);
  return s.field == nullptr ? code : code + " " + s.field;
}

class CInstance {
 public:
  CInstance() { EXPECT_EQ(volcomp_create(memory_.get(), sizeof *memory_, &c_).reason, VOLCOMP_OK); }

  [[nodiscard]] volcomp_compensator* get() const { return c_; }
  [[nodiscard]] unsigned char* bytes() const { return memory_->bytes; }
  volcomp_status stage(const Bytes& image, const double* tool_mm = nullptr) {
    return volcomp_stage(c_, image.data(), image.size(), tool_mm);
  }

  // Nothing limited, nothing delayed, as open_settings().
  void open() {
    volcomp_settings s;
    volcomp_default_settings(&s);
    s.positions = VOLCOMP_ACTUAL;
    s.ramp_ticks = 1;
    for (volcomp_axis_limits& l : s.axis)
      l = {4'194'303, 1'000'000'000, 1'000'000'000, 0, 0, 0};
    EXPECT_EQ(volcomp_configure(c_, &s).reason, VOLCOMP_OK);
  }
  void start(const MachineTables& tables, const double* tool_mm = nullptr) {
    ASSERT_EQ(stage(encode(tables), tool_mm).reason, VOLCOMP_OK);
    open();
    ASSERT_EQ(volcomp_activate(c_).reason, VOLCOMP_OK);
  }
  const volcomp_output& tick(const std::array<std::int64_t, kMaxAxes>& q) {
    volcomp_input in{};
    for (std::size_t a = 0; a < VOLCOMP_AXES; ++a)
      in.axis[a] = {q[a], true, true};
    volcomp_tick(c_, &in, &out_);
    return out_;
  }

 private:
  std::unique_ptr<volcomp_memory> memory_ = std::make_unique<volcomp_memory>();
  volcomp_compensator* c_ = nullptr;
  volcomp_output out_{};
};

}  // namespace volcomp::test
