#pragma once
// A drive as people own it, from its data sheet: what the set-up of a machine depends on.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "host_sim/host/bus/bus_settings.hpp"
#include "host_sim/host/bus/device_files/eds_file.hpp"

namespace volcomp::host {

class DriveModel {
 public:
  // `name`: for people.
  DriveModel(std::string name, EdsFile eds) : name_(std::move(name)), eds_(std::move(eds)) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const EdsFile& eds() const { return eds_; }

  [[nodiscard]] bool has(canopen::ObjectId object) const { return eds_.find(object) != nullptr; }
  [[nodiscard]] bool may_map(canopen::PdoKind kind, canopen::ObjectId object) const;

  // 60B0h in a TPDO.
  [[nodiscard]] bool reports_offset() const;
  // SYNC with a counter: 1019h.
  [[nodiscard]] bool counts_sync() const;
  // Touch probe 1: 60B8h, and 60B9h and 60BAh in TPDOs.
  [[nodiscard]] bool latches() const;
  // What it says of a latch: 60D1h and 60D5h in TPDOs.
  [[nodiscard]] bool times_latches() const;
  [[nodiscard]] bool counts_edges() const;

  // Why an axis cannot be corrected in this way, what is missing as an object; empty: it can.
  [[nodiscard]] std::string obstacle(Way way) const;

  // The first way that nothing stands in: the offset, or the forwarded target.
  [[nodiscard]] Way fitting_way() const;

  // What a simulated drive of this model counts in, see docs/drives.md.
  [[nodiscard]] DriveScale usual_scale(bool rotary) const;

 private:
  std::string name_;
  EdsFile eds_;
};

// The data sheet of that name that comes with the program, or the file of that path from `folder`.
// Throws UserError as find_drive_eds().
[[nodiscard]] std::shared_ptr<const DriveModel> find_drive_model(
    const std::string& name_or_path, const std::filesystem::path& folder = {});

// The axis has a drive of this model from now on: 2207h follows from it. Throws UserError with what
// the drive lacks for the way of the axis.
void put_model(BusAxis& axis, std::shared_ptr<const DriveModel> model);
// The drive of the axis counts in other units; its software limits stay where they are.
void change_scale(BusAxis& axis, const DriveScale& scale);
// The same for every axis, in the usual units of the model; an axis that would be corrected by its
// offset is by a forwarded target where the model has no offset. `names`: one for all axes, or one
// for each. Throws UserError as the functions it calls, and for another number of names.
[[nodiscard]] BusSettings with_models(BusSettings settings, const std::vector<std::string>& names);
// Throws UserError where the machine has a probe and the drive of an axis no input for it.
void require_latches(const BusSettings& settings);

}  // namespace volcomp::host
