#pragma once
// Every kind of case, by paper: each handler drives the public interface of the library and nothing
// else.

#include "tests/cases/case_file.hpp"

namespace volcomp::cases {

void add_id_geometry(Handlers& handlers);
void add_id_solution(Handlers& handlers);
void add_measured_gears(Handlers& handlers);
void add_measured_intervals(Handlers& handlers);
void add_measured_refusals(Handlers& handlers);
void add_measurement(Handlers& handlers);
void add_measuring_instruments(Handlers& handlers);
void add_offset_limits(Handlers& handlers);
void add_s0_calibration(Handlers& handlers);
void add_s0_gear(Handlers& handlers);
void add_s0_geometry(Handlers& handlers);
void add_s1_geometry(Handlers& handlers);
void add_s1_tables(Handlers& handlers);
void add_s1_compensation(Handlers& handlers);
void add_s1_bad_input(Handlers& handlers);
void add_s2_maps(Handlers& handlers);
void add_s2_face(Handlers& handlers);
void add_s2_frame(Handlers& handlers);
void add_s3_evaluation(Handlers& handlers);
void add_s3_flank(Handlers& handlers);
void add_s3_geometry(Handlers& handlers);
void add_s3_learning(Handlers& handlers);
void add_s3_table_file(Handlers& handlers);

}  // namespace volcomp::cases
