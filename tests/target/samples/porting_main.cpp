// The sample of docs/porting.md with what it leaves to its reader: an image, here the one of the
// servo example.

#include "comp/core/span.hpp"
#include "comp/tables/image.hpp"
#include "comp/tick/instances.hpp"
#include "firmware/boards/mps2/exit_code.hpp"

#include "porting_sample.inl"

extern "C" const std::uint8_t servo_tables_begin[];
extern "C" const std::uint8_t servo_tables_end[];

int main() {
  const volcomp::Span<const std::uint8_t> image{
      servo_tables_begin, static_cast<std::size_t>(servo_tables_end - servo_tables_begin)};
  const volcomp::Status status = load(image, {});
  volcomp::LoadedCompensator::Output out;
  compensator().tick({}, out);
  return status.ok() && compensator().active() ? volcomp::boards::kFine
                                               : volcomp::boards::kCheckFailed;
}
