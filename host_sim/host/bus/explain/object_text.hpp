#pragma once
// Objects of the node for people: as a section of a page, and for a terminal.

#include <string>
#include <vector>

#include "host_sim/host/bus/device_files/eds_objects.hpp"

namespace volcomp::host {

// Neighbours that differ by nothing but a number stand together: PDO parameters, learned tables,
// counters of the axes.
[[nodiscard]] std::vector<std::vector<EdsObject>> objects_alike();

[[nodiscard]] std::string object_section(const std::vector<EdsObject>& group);
[[nodiscard]] std::string object_text(const EdsObject& object);

// "u16"
[[nodiscard]] const char* type_name(canopen::DataType type);
// What an object of the node is for, by index; nullptr where nothing is known of it.
[[nodiscard]] const char* purpose(unsigned index);
// The same, empty where there is no text.
[[nodiscard]] const char* purpose_of(const EdsObject& object);

}  // namespace volcomp::host
