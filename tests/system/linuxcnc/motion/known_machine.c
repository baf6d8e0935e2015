// A realtime component of LinuxCNC: the machine of known_errors.h with drives that follow every
// command at once. Its axes stand somewhere when it is switched on, and the encoders count from
// there, so that homing has something to find.
//
//   known.x.drive   float in   mm from where it was switched on
//   known.x.encoder float out  the same, as it is
//   known.x.tool    float out  mm, where the tool really is over the work
//   known.x.switch  bit out    home switch, 5 mm before the end of the travel

#include "known_errors.h"

#include "hal.h"
#include "rtapi.h"
#include "rtapi_app.h"

MODULE_AUTHOR("volcomp");
MODULE_DESCRIPTION("A machine with known geometric errors");
MODULE_LICENSE("Apache-2.0");

static const double switched_on_at[KNOWN_AXES] = {120.0, 90.0, -60.0};

struct axis_pins {
  hal_float_t* drive;
  hal_float_t* encoder;
  hal_float_t* tool;
  hal_bit_t* home_switch;
};

static int component;
static struct axis_pins* pins;
static double extreme[KNOWN_AXES];  // furthest of the motion in its direction
static int direction[KNOWN_AXES] = {1, 1, 1};

// Backlash changes sides after 2 µm.
static void follow(int axis, double position) {
  const double back = direction[axis] * (extreme[axis] - position);
  if (back > 0.002) direction[axis] = -direction[axis];
  if (back > 0.002 || back < 0.0) extreme[axis] = position;
}

// mm and mrad, zero at the reference at 0 mm in the mean of both directions.
static void error_of(int axis, double position, double error[6]) {
  double up[6], down[6];
  known_errors(axis, position, direction[axis], error);
  known_errors(axis, 0.0, 1, up);
  known_errors(axis, 0.0, -1, down);
  for (int c = 0; c < 6; ++c)
    error[c] = (error[c] - 0.5 * (up[c] + down[c])) * 1e-3;
}

// What an axis does to the tool at the end of its lever, mm: ISO 230-1, translation and rotation
// times lever.
static void add(const double error[6], const double lever[3], double sum[3]) {
  for (int c = 0; c < 3; ++c) {
    const int next = (c + 1) % 3, after = (c + 2) % 3;
    const double turned = error[3 + next] * lever[after] - error[3 + after] * lever[next];
    sum[c] += error[c] + 1e-3 * turned;
  }
}

static void move(void* unused, long period_ns) {
  double at[KNOWN_AXES], error[6], sum[3] = {0.0, 0.0, 0.0};
  (void)unused;
  (void)period_ns;
  for (int a = 0; a < KNOWN_AXES; ++a) {
    *pins[a].encoder = *pins[a].drive;
    at[a] = switched_on_at[a] + *pins[a].drive;
    follow(a, at[a]);
  }
  // From where each axis was measured to the tool (machine.toml).
  const double lever[KNOWN_AXES][3] = {
      {at[0], at[1], at[2] - 250.0}, {0.0, at[1], at[2] - 250.0}, {0.0, 0.0, 0.0}};
  for (int a = 0; a < KNOWN_AXES; ++a) {
    error_of(a, at[a], error);
    add(error, lever[a], sum);
  }
  for (int a = 0; a < KNOWN_AXES; ++a)
    *pins[a].tool = at[a] + sum[a];
  *pins[0].home_switch = at[0] <= 5.0;
  *pins[1].home_switch = at[1] <= 5.0;
  *pins[2].home_switch = at[2] >= -5.0;
}

static int export_axis(struct axis_pins* axis, char letter) {
  int r = hal_pin_float_newf(HAL_IN, &axis->drive, component, "known.%c.drive", letter);
  if (r == 0)
    r = hal_pin_float_newf(HAL_OUT, &axis->encoder, component, "known.%c.encoder", letter);
  if (r == 0) r = hal_pin_float_newf(HAL_OUT, &axis->tool, component, "known.%c.tool", letter);
  if (r == 0)
    r = hal_pin_bit_newf(HAL_OUT, &axis->home_switch, component, "known.%c.switch", letter);
  return r;
}

int rtapi_app_main(void) {
  int r = 0;
  component = hal_init("known_machine");
  if (component < 0) return component;
  pins = hal_malloc(KNOWN_AXES * sizeof *pins);
  if (pins == NULL) r = -1;
  for (int a = 0; a < KNOWN_AXES && r == 0; ++a)
    r = export_axis(&pins[a], "xyz"[a]);
  if (r == 0) r = hal_export_funct("known.move", move, NULL, 1, 0, component);
  if (r == 0) r = hal_ready(component);
  if (r != 0) hal_exit(component);
  return r;
}

void rtapi_app_exit(void) { hal_exit(component); }
