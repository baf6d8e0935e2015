#include "host_sim/host/tables/learned_tables.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

node::LearnedLayout layout_of(const LearnedTables& tables, std::uint32_t machine_id,
                              double feed_mm_per_s) {
  node::LearnedLayout layout;
  layout.machine_id = machine_id;
  layout.nodes = static_cast<std::uint16_t>(tables.stroke[0].size());
  layout.slots = static_cast<std::uint16_t>(tables.slot.size());
  layout.first_node_nm = to_nm(tables.z0_mm);
  layout.pitch_nm = static_cast<std::uint32_t>(to_nm(tables.pitch_mm));
  layout.feed_nm_per_s = static_cast<std::int32_t>(to_nm(feed_mm_per_s));
  return layout;
}

}  // namespace

std::vector<std::uint8_t> learned_image(const LearnedTables& tables, std::uint32_t machine_id,
                                        double feed_mm_per_s) {
  const node::LearnedLayout layout = layout_of(tables, machine_id, feed_mm_per_s);
  std::vector<std::uint8_t> image(layout.bytes());
  node::encode_learned(layout, {tables.stroke[0], tables.stroke[1], tables.slot}, image);
  return image;
}

LearnedTables read_learned(const std::vector<std::uint8_t>& image, const LearnedTables& like,
                           std::uint32_t machine_id, double most_rad, const std::string& name) {
  require(node::check_learned(image, layout_of(like, machine_id, 0.0), most_rad), name);
  LearnedTables tables = like;
  std::size_t at = 0;
  for (std::vector<double>* table : {&tables.stroke.front(), &tables.stroke.back(), &tables.slot}) {
    for (double& value : *table)
      value = node::learned_value(image, at++);
  }
  return tables;
}

}  // namespace volcomp::host
