// What the HAL component has to put out: servo periods of any machine, as volcomp.h computes them.
// The settings are those that hal_test.sh gives the component.
//
//   reference TABLE_IMAGE PERIODS INPUT OUTPUT LOWER UPPER…   of every axis, mm or degrees
//
// INPUT: rows for halstreamer: of every axis position (mm or degrees), valid, homed; then enable.
// OUTPUT: rows as halsampler writes them: of every axis offset, status, out of range and far out of
// range, which a referenced axis shows; then compensating.

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "volcomp.h"

static union volcomp_memory memory;
static unsigned char image[VOLCOMP_BYTES];

static uint32_t next_random(uint32_t* state) {
  *state = *state * 1664525U + 1013904223U;
  return *state >> 8U;
}

static size_t load(const char* path) {
  FILE* const file = fopen(path, "rb");
  if (file == NULL) return 0;
  const size_t size = fread(image, 1, sizeof image, file);
  fclose(file);
  return size;
}

// At 1 kHz 60 µm, 5 mm/s, 0.1 s, hysteresis 2 µm; 1 mrad, 50 mrad/s, 0.1 s, hysteresis 20 µrad. The
// component's own acceleration: 0.2 m/s², 2 rad/s².
static struct volcomp_compensator* commission(const char* path, struct volcomp_machine* machine) {
  static const struct volcomp_axis_limits linear = {60000, 5000, 600, 2000, 0, 200};
  static const struct volcomp_axis_limits rotary = {683565, 34178, 6836, 13671, 0, 1367};
  struct volcomp_compensator* c = NULL;
  struct volcomp_settings s;
  if (volcomp_create(&memory, sizeof memory, &c).reason != VOLCOMP_OK) return NULL;
  if (volcomp_stage(c, image, load(path), NULL).reason != VOLCOMP_OK) return NULL;
  volcomp_describe(c, machine);
  volcomp_default_settings(&s);
  for (size_t a = 0; a < VOLCOMP_AXES; ++a)
    s.axis[a] = machine->rotary[a] ? rotary : linear;
  s.ramp_ticks = 100;
  if (volcomp_configure(c, &s).reason != VOLCOMP_OK) return NULL;
  return volcomp_activate(c).reason == VOLCOMP_OK ? c : NULL;
}

// Prints a position, fine enough that it comes back as the same number of units.
static void print_position(FILE* file, bool rotary, int64_t units) {
  fprintf(file, "%.12f ", (double)units * (rotary ? 360.0 / VOLCOMP_UNITS_PER_TURN : 1e-6));
}

static void print_offset(FILE* file, bool rotary, int32_t units) {
  fprintf(file, "%f ", units / (rotary ? 4294967296.0 / 360.0 : 1e6));
}

static void print_status(FILE* file, unsigned status) {
  const bool homed = (status & VOLCOMP_NOT_HOMED) == 0;
  fprintf(file, "%u %d %d ", status, homed && (status & VOLCOMP_OUT_OF_RANGE) != 0,
          homed && (status & VOLCOMP_FAR_OUT_OF_RANGE) != 0);
}

// One axis that wanders between two ends, at another speed every 50 ms.
struct wanderer {
  int64_t lower, upper, position, velocity;
};

static void move(struct wanderer* w, long period, uint32_t* random) {
  const int64_t fastest = (w->upper - w->lower) / 1000 + 1;
  if (period % 50 == 0)
    w->velocity = (int64_t)(next_random(random) % 2001U - 1000.0) * fastest / 1000;
  if (w->position < w->lower) w->velocity = fastest;
  if (w->position > w->upper) w->velocity = -fastest;
  w->position += w->velocity;
}

int main(int argc, char** argv) {
  struct volcomp_machine machine = {0};
  struct volcomp_compensator* const c = argc > 5 ? commission(argv[1], &machine) : NULL;
  FILE* const rows = c == NULL ? NULL : fopen(argv[3], "w");
  FILE* const answers = rows == NULL ? NULL : fopen(argv[4], "w");
  if (answers == NULL || (uint32_t)argc != 5 + 2 * machine.axes) {
    fputs("reference: arguments, image or file\n", stderr);
    return 2;
  }
  struct wanderer axis[VOLCOMP_AXES];
  for (size_t a = 0; a < machine.axes; ++a) {
    const double scale = machine.rotary[a] ? VOLCOMP_UNITS_PER_TURN / 360.0 : 1e6;
    const struct wanderer w = {(int64_t)(atof(argv[5 + 2 * a]) * scale),
                               (int64_t)(atof(argv[6 + 2 * a]) * scale), 0, 0};
    axis[a] = w;
    axis[a].position = (w.lower + w.upper) / 2;
  }
  uint32_t random = 1;
  struct volcomp_input in = {{{0, false, false}}};
  struct volcomp_output out;
  const long periods = atol(argv[2]);
  for (long n = 0; n < periods; ++n) {
    const bool enable = n < periods / 2 || n > periods / 2 + 300;
    bool all_valid = true;
    for (size_t a = 0; a < machine.axes; ++a) {
      move(&axis[a], n, &random);
      const bool valid = next_random(&random) % 200U != 0U;
      const bool homed = n > 20;
      print_position(rows, machine.rotary[a], axis[a].position);
      fprintf(rows, "%d %d ", valid, homed);
      const struct volcomp_sample sample = {axis[a].position, valid, homed && enable};
      in.axis[a] = sample;
    }
    fprintf(rows, "%d\n", enable);
    volcomp_tick(c, &in, &out);
    for (size_t a = 0; a < machine.axes; ++a) {
      print_offset(answers, machine.rotary[a], out.offset[a]);
      print_status(answers, out.status[a]);
      all_valid = all_valid && (out.status[a] & VOLCOMP_VALID) != 0;
    }
    fprintf(answers, "%d\n", all_valid);
  }
  return fclose(rows) == 0 && fclose(answers) == 0 ? 0 : 2;
}
