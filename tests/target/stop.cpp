#include "tests/target/stop.hpp"

#include "hal/mps2/semihosting.hpp"
#include "tests/target/text.hpp"

namespace volcomp::target {

void stop(const char* sentence) {
  put(sentence);
  put('\n');
  hal::mps2::semihosting::exit(1);
  for (;;) {
  }
}

}  // namespace volcomp::target
