#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/measure/strokes/stroke_log.hpp"

namespace volcomp::host {

StrokeLog read_stroke_log(const std::filesystem::path& path, const MachineFile& machine) {
  InputFile file(path);
  std::istream& stream = file.stream();
  return (stream >> std::ws).peek() == '(' ? read_stroke_frames(stream, file.name(), machine)
                                           : read_stroke_table(stream, file.name());
}

}  // namespace volcomp::host
