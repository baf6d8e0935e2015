#include "host_sim/host/tables/learned_files.hpp"

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/formats/isg_ssfk.hpp"
#include "host_sim/host/tables/formats/linuxcnc_comp.hpp"
#include "host_sim/host/tables/formats/siemens_cec.hpp"
#include "host_sim/host/tables/formats/siemens_enc_comp.hpp"

namespace volcomp::host {
namespace {

LearnedFile cross_compensation(const LearnedTables& tables, std::size_t direction) {
  CecTable cec;
  cec.number = static_cast<int>(direction);
  cec.input = "Z1";
  cec.output = "C1";
  cec.offset = tables.stroke.at(direction);
  cec.min = tables.z0_mm;
  cec.step = tables.pitch_mm;
  cec.direction = direction == 0 ? 1 : -1;
  cec.rotary = true;
  const char* name = direction == 0 ? "siemens_cec_z_to_c_up.ini" : "siemens_cec_z_to_c_down.ini";
  LearnedFile file{name, "", direction == 0 ? "T1, Z upwards" : "T1, Z downwards"};
  require(write_cec(cec, file.text), file.name);
  return file;
}

// C stands at −k pitches while slot k is ground, so the entries come in reverse order. During a
// stroke C also turns by the helix, past the entries of neighbouring slots: the wave once per turn
// is kept, what is different from slot to slot is smeared.
LearnedFile slots_around_c(const LearnedTables& tables) {
  const std::size_t teeth = tables.slot.size();
  EncCompTable table;
  table.axis = "C1";
  for (std::size_t k = 0; k <= teeth; ++k)
    table.offset.push_back(tables.slot[(teeth - k) % teeth]);
  table.step = 360.0 / static_cast<double>(teeth);
  table.modulo = true;
  table.rotary = true;
  LearnedFile file{"siemens_enc_comp_c.ini", "", "T2 around C, smeared over two slots"};
  require(write_enc_comp(table, file.text), file.name);
  return file;
}

struct OffsetsOfZ {
  std::vector<double> nominal;
  std::array<std::vector<double>, 2> offset;  // mm, by direction
};

// e_s = e_C + e_Z / p: an offset of C and p times as much of Z leave the same flank.
OffsetsOfZ offsets_of_z(const InternalGear& gear, const LearnedTables& tables) {
  OffsetsOfZ z;
  for (std::size_t j = 0; j < tables.stroke[0].size(); ++j) {
    z.nominal.push_back(tables.z0_mm + tables.pitch_mm * static_cast<double>(j));
    for (std::size_t d = 0; d < z.offset.size(); ++d)
      z.offset[d].push_back(gear.screw_parameter() * tables.stroke[d][j]);
  }
  return z;
}

}  // namespace

std::vector<LearnedFile> learned_files(const InternalGear& gear, const LearnedTables& tables) {
  const OffsetsOfZ z = offsets_of_z(gear, tables);
  LearnedFile linuxcnc{"linuxcnc_z.comp", "", "T1 as offsets of Z, COMP_FILE_TYPE 1"};
  require(write_linuxcnc({1, z.nominal, z.offset[0], z.offset[1]}, linuxcnc.text), linuxcnc.name);
  LearnedFile isg{"isg_ssfk_z.lis", "", "T1 as offsets of Z"};
  require(write_ssfk({2, "Z", z.nominal, z.offset[0], z.offset[1], false}, isg.text), isg.name);
  return {cross_compensation(tables, 0), cross_compensation(tables, 1), slots_around_c(tables),
          linuxcnc, isg};
}

}  // namespace volcomp::host
