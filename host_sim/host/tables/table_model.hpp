#pragma once
// The tables of an image as a model in double: what is exported is what the node would compute.

#include <filesystem>
#include <memory>
#include <vector>

#include "comp/metrology/tables/volumetric_model.hpp"
#include "comp/tables/machine_tables.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Owns the tables its model points at.
struct TableModel {
  std::vector<std::unique_ptr<ErrorTable>> tables;  // by NC axis, mm and rad
  VolumetricModel model;
};

// Throws UserError with `name` when the machine is refused.
[[nodiscard]] TableModel table_model(const MachineTables& tables, const std::string& name);

// The content of an image file (.vct).
struct TableImage {
  std::string name;
  std::size_t bytes = 0;
  std::uint32_t crc = 0;  // that names it
  std::unique_ptr<MachineTables> tables;
};

// Throws UserError naming the file for bytes that are no image. The values of its tables are not
// checked: a node may refuse them.
[[nodiscard]] TableImage read_table_image(const std::filesystem::path& path);

// A node takes tables over by folding them, which bounds their values. Throws UserError with `name`
// for what every node would refuse.
void require_foldable(const MachineTables& tables, const std::string& name);

// Throws UserError unless the tables of `image` are of the machine of the file: its id and its
// chain of bodies.
void require_same_machine(const MachineTables& tables, const std::string& image,
                          const MachineFile& machine);

// An image file (.vct), checked as the node checks it: the bytes, and that its tables are
// plausible. Throws UserError naming the file.
[[nodiscard]] std::unique_ptr<MachineTables> read_tables_file(const std::filesystem::path& path);

}  // namespace volcomp::host
