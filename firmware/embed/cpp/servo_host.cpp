// The servo example as a program of this computer: what a board prints, to compare with.
//
//   volcomp-servo TABLE_IMAGE
//
// Exit codes: 0 done, 2 an image that cannot be used.

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "firmware/embed/cpp/servo_example.hpp"

namespace {

using volcomp::example::ServoExample;

struct StandardOutput {
  static void put(const char* text) { std::printf("%s", text); }
  static void put_unsigned(std::uint32_t value) { std::printf("%" PRIu32, value); }
  static void put_decimal(std::int32_t value) { std::printf("%" PRId32, value); }
  static void put_hex(std::uint32_t value) { std::printf("0x%08" PRIx32, value); }
};

int run(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  const std::vector<std::uint8_t> image(bytes.begin(), bytes.end());
  const auto example = std::make_unique<ServoExample>();
  const volcomp::Status status = example->commission(image);
  if (!status.ok()) {
    static_cast<void>(
        std::fprintf(stderr, "volcomp-servo: %s: %s\n", path, sentence(status.reason)));
    return 2;
  }
  while (example->summary().periods < ServoExample::kPeriods) {
    example->machine().advance();
    example->on_servo_interrupt();
  }
  StandardOutput output;
  tell(example->summary(), output);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2) return run(argv[1]);
  static_cast<void>(std::fputs("usage: volcomp-servo TABLE_IMAGE\n", stderr));
  return 2;
}
