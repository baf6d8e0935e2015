#pragma once
// The tables of an image as a model in double: what is exported is what the node would compute.

#include <filesystem>
#include <memory>
#include <vector>

#include "comp/metrology/tables/volumetric_model.hpp"
#include "comp/tables/machine_tables.hpp"

namespace volcomp::host {

// Owns the tables its model points at.
struct TableModel {
  std::vector<std::unique_ptr<ErrorTable>> tables;  // by NC axis, mm and rad
  VolumetricModel model;
};

// Throws UserError with `name` when the machine is refused.
[[nodiscard]] TableModel table_model(const MachineTables& tables, const std::string& name);

// An image file (.vct), checked as the node checks it: the bytes, and that its tables can be meant.
// Throws UserError naming the file.
[[nodiscard]] std::unique_ptr<MachineTables> read_tables_file(const std::filesystem::path& path);

}  // namespace volcomp::host
