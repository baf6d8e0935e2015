// The smallest motion controller in C99 with volumetric compensation: the machine and the servo
// loop of firmware/embed/cpp/servo_example.hpp. Prints what the offsets were, to the last bit the
// same as volcomp-servo.
//
//   volcomp-servo-c TABLE_IMAGE
//
// Exit codes: 0 done, 2 an image that cannot be used.

#include <inttypes.h>
#include <stdio.h>

#include "volcomp.h"

enum { AXES = 3, SERVO_HZ = 5000, SIGNAL_FAILS = 12000, SIGNAL_RETURNS = 12050, FAILING_AXIS = 1 };

// What a real controller reads from its counters: nm.
struct simulated_axis {
  int32_t lower, upper, step;  // 10 nm; step per servo period
  int32_t count;
  bool upwards;
};

static struct simulated_axis machine[AXES] = {
    {-50200000, -100000, 2200, 0, false},
    {-29900000, -100000, 1300, 0, false},
    {-39900000, -100000, 700, 0, false},
};

struct summary {
  int32_t least[AXES], largest[AXES], last[AXES];
  uint32_t fingerprint;  // of every offset and status word (FNV-1a, by words)
};

static union volcomp_memory memory;
static unsigned char image[VOLCOMP_BYTES];

static void advance(uint32_t period, struct simulated_axis* axis) {
  const int32_t here = period == 0 ? axis->upper : axis->count;
  if (here <= axis->lower) axis->upwards = true;
  if (here >= axis->upper) axis->upwards = false;
  axis->count = here + (axis->upwards ? axis->step : -axis->step);
}

static void sample(uint32_t period, struct volcomp_input* in) {
  for (size_t a = 0; a < AXES; ++a) {
    const bool failed = a == FAILING_AXIS && period >= SIGNAL_FAILS && period < SIGNAL_RETURNS;
    in->axis[a].position = INT64_C(10) * machine[a].count;
    in->axis[a].valid = !failed;
    in->axis[a].homed = true;
  }
}

static void add(const struct volcomp_output* out, struct summary* sum) {
  const uint32_t prime = 16777619U;
  for (size_t a = 0; a < AXES; ++a) {
    const int32_t offset = out->offset[a];
    if (offset < sum->least[a]) sum->least[a] = offset;
    if (offset > sum->largest[a]) sum->largest[a] = offset;
    sum->last[a] = offset;
    sum->fingerprint = (sum->fingerprint ^ (uint32_t)offset) * prime;
    sum->fingerprint = (sum->fingerprint ^ out->status[a]) * prime;
  }
}

static void tell(uint32_t periods, const struct summary* sum) {
  static const char names[AXES] = {'X', 'Y', 'Z'};
  printf("servo periods at 5 kHz    %" PRIu32, periods);
  for (size_t a = 0; a < AXES; ++a) {
    printf("\noffset %c, nm: least %" PRId32 ", largest %" PRId32 ", last %" PRId32, names[a],
           sum->least[a], sum->largest[a], sum->last[a]);
  }
  printf("\nfingerprint of all        0x%08" PRIx32 "\n", sum->fingerprint);
}

// 5 mm/s and 0.2 m/s² of offset, 0.5 mm/s while an axis is lost, plausible up to 0.25 m/s.
static struct volcomp_status limit(struct volcomp_axis_limits* limits) {
  const double period_s = 1.0 / SERVO_HZ;
  limits->limit = 200000;  // nm
  limits->hysteresis = 2000;
  struct volcomp_status s = volcomp_set_rate(limits, false, 5.0, 0.5, period_s);
  if (s.reason == VOLCOMP_OK) s = volcomp_set_acceleration(limits, false, 0.2, period_s);
  if (s.reason == VOLCOMP_OK) s = volcomp_set_max_speed(limits, false, 250.0, period_s);
  return s;
}

// 0.4 s for a change; an axis without a signal for 4 ms counts as lost.
static struct volcomp_status commission(size_t bytes, struct volcomp_compensator** compensation) {
  struct volcomp_settings settings;
  volcomp_default_settings(&settings);
  struct volcomp_status s = volcomp_set_times(&settings, 0.4, 0.004, 1.0 / SERVO_HZ);
  for (size_t a = 0; a < VOLCOMP_AXES && s.reason == VOLCOMP_OK; ++a)
    s = limit(&settings.axis[a]);
  if (s.reason == VOLCOMP_OK) s = volcomp_create(&memory, sizeof memory, compensation);
  if (s.reason == VOLCOMP_OK) s = volcomp_configure(*compensation, &settings);
  if (s.reason == VOLCOMP_OK) s = volcomp_stage(*compensation, image, bytes, NULL);
  if (s.reason == VOLCOMP_OK) s = volcomp_activate(*compensation);
  return s;
}

int main(int argc, char** argv) {
  if (argc != 2) {
    (void)fputs("usage: volcomp-servo-c TABLE_IMAGE\n", stderr);
    return 2;
  }
  FILE* file = fopen(argv[1], "rb");
  const size_t bytes = file == NULL ? 0 : fread(image, 1, sizeof image, file);
  if (file != NULL) (void)fclose(file);

  struct volcomp_compensator* compensation = NULL;
  const struct volcomp_status status = commission(bytes, &compensation);
  if (status.reason != VOLCOMP_OK) {
    (void)fprintf(stderr, "volcomp-servo-c: %s: %s\n", argv[1], volcomp_sentence(status.reason));
    return 2;
  }

  struct volcomp_input in = {{{0, false, false}}};
  struct volcomp_output out;
  struct summary sum = {{0}, {0}, {0}, 2166136261U};
  uint32_t period = 0;
  for (; period < 8 * SERVO_HZ; ++period) {
    for (size_t a = 0; a < AXES; ++a)
      advance(period, &machine[a]);
    sample(period, &in);
    volcomp_tick(compensation, &in, &out);  // in a controller: in its servo interrupt
    add(&out, &sum);
  }
  tell(period, &sum);
  return 0;
}
