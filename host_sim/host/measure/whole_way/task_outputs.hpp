#pragma once
// What is asked of the tables of a campaign: the error at every place of a task, and figures of the
// task made from these.

#include <string>
#include <vector>

#include "comp/machine/error_motion.hpp"
#include "comp/metrology/tables/volumetric_model.hpp"
#include "host_sim/host/measure/whole_way/task.hpp"

namespace volcomp::host {

// Errors of the tool point in base at all places, mm.
using TaskErrors = std::vector<Vec3>;

struct FigureOfTask {
  enum class Kind {
    from_nominal,  // largest distance from the errors of the nominal tables
    largest,       // largest error
    from_first,    // largest difference from the error at the first place
    rigid,         // largest error after the rigid motion that fits best is taken off
    along,         // range of the component along a line
  } kind;
  const char* key;
  const char* name;
};

class TaskOutputs {
 public:
  TaskOutputs(const MachineFile& machine, const Task& task, Travel travel);

  // Those that this task has; none of a point.
  [[nodiscard]] const std::vector<FigureOfTask>& figures() const { return figures_; }
  // The model as the tick has it, in double.
  [[nodiscard]] TaskErrors errors(const VolumetricModel& model) const;
  // mm
  [[nodiscard]] double figure(const FigureOfTask& figure, const TaskErrors& errors,
                              const TaskErrors& nominal) const;
  // Unit vector of a line in base; 0 of another task, and of a line along which no linear axis
  // moves.
  [[nodiscard]] const Vec3& direction() const { return direction_; }

 private:
  const Task& task_;
  Travels travels_{};
  std::vector<FigureOfTask> figures_;
  std::vector<Vec3> way_;  // of the tool in base, mm
  Vec3 direction_ = Vec3::Zero();
};

}  // namespace volcomp::host
