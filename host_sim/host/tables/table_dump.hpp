#pragma once
// Everything a table image holds, readable: the machine, the origin of the tables, and every knot.
// Values are those of the image: body values on the moving side (docs/conventions.md, section 2).

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/host/tables/table_model.hpp"

namespace volcomp::host {

// Name, size and CRC-32 of the image, machine, origin, directions and growth: a line each.
[[nodiscard]] std::string image_text(const TableImage& image);

// image_text() as comments, then a row for each axis, knot and direction of travel:
//
//   axis,knot,direction,position [mm],position [rad],EX [um],EY [um],EZ [um],EA [urad],…
//
// The position of the other kind of axis is empty. Nine digits hold every float.
[[nodiscard]] std::string tables_csv(const TableImage& image);

[[nodiscard]] nlohmann::json tables_json(const TableImage& image);

}  // namespace volcomp::host
