// LinuxCNC: volumetric compensation as a realtime component over volcomp.h. Positions in, offsets
// out, in the same servo period.
//
//   loadrt volcomp image=/etc/machine.vct
//   addf volcomp.update servo-thread        (after motion, before the drives)
//
// Beside this file volcomp.hal shows the whole wiring of a machine of three axes.
//
// Pins of every axis of the image, for instance of X:
//
//   volcomp.x.position          float in   mm or degrees of the machine; what motion commands:
//                                          joint.N.pos-cmd, never joint.N.motor-pos-cmd, which
//                                          holds the joint.N.motor-offset of homing, too
//   volcomp.x.valid             bit in     the position can be relied on
//   volcomp.x.homed             bit in     the axis is referenced
//   volcomp.x.offset            float out  mm or degrees, to be added to the command
//   volcomp.x.status            u32 out    VOLCOMP_VALID … of volcomp.h
//   volcomp.x.out-of-range      bit out    referenced and beyond its table: corrected as at its end
//   volcomp.x.far-out-of-range  bit out    by more than half a pitch: for a message to the operator
//   volcomp.x.limited           bit out    held back by its rate or acceleration in this period
//   volcomp.x.lag               float out  mm or degrees that it was held back by at most, so far
//
// and of all: volcomp.enable (bit in; false: all offsets go to 0), volcomp.compensating (bit out:
// every axis is corrected as configured), volcomp.image-crc (u32 out).
//
// The file is read and checked when the module is loaded; a bad one is refused, and the module with
// it. In the thread: no heap, bounded, one call of volcomp_tick().

#include <ctype.h>
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "hal.h"
#include "rtapi.h"
#include "rtapi_app.h"
#include "volcomp.h"

MODULE_AUTHOR("volcomp");
MODULE_DESCRIPTION("Volumetric error compensation");
MODULE_LICENSE("Apache-2.0");

static char* image = NULL;
RTAPI_MP_STRING(image, "table image, as volcomp build-tables writes it");
static int period_us = 1000;
RTAPI_MP_INT(period_us, "of the thread that volcomp.update is added to");
static int limit_um = 200;
RTAPI_MP_INT(limit_um, "largest offset of a linear axis");
static int limit_urad = 1000;
RTAPI_MP_INT(limit_urad, "largest offset of a rotary axis");
static int rate_um_per_s = 10000;
RTAPI_MP_INT(rate_um_per_s, "fastest change of the offset of a linear axis");
static int rate_urad_per_s = 100000;
RTAPI_MP_INT(rate_urad_per_s, "fastest change of the offset of a rotary axis");
static int acceleration_mm_per_s2 = -1;
RTAPI_MP_INT(acceleration_mm_per_s2,
             "largest acceleration of the offset of a linear axis; 0: any; -1: a tenth of its "
             "max_acceleration, without that 200");
static int acceleration_mrad_per_s2 = -1;
RTAPI_MP_INT(acceleration_mrad_per_s2,
             "largest acceleration of the offset of a rotary axis; 0: any; -1: a tenth of its "
             "max_acceleration, without that 2000");
static char* max_acceleration[VOLCOMP_AXES];
RTAPI_MP_ARRAY_STRING(max_acceleration, VOLCOMP_AXES,
                      "[JOINT_n]MAX_ACCELERATION of the axes in the order of the image, mm/s^2 or "
                      "degrees/s^2");
static int ramp_ms = 200;
RTAPI_MP_INT(ramp_ms, "for new tables, and for offsets of an axis that was lost or is back");
static int hysteresis_nm = 2000;
RTAPI_MP_INT(hysteresis_nm, "of the direction of a linear axis");
static int hysteresis_nrad = 20000;
RTAPI_MP_INT(hysteresis_nrad, "of the direction of a rotary axis");
static int actual = 0;
RTAPI_MP_INT(actual, "1: positions are those of the encoders and already contain the offset");

struct axis_pins {
  hal_float_t* position;
  hal_bit_t* valid;
  hal_bit_t* homed;
  hal_float_t* offset;
  hal_u32_t* status;
  hal_bit_t* out_of_range;
  hal_bit_t* far_out_of_range;
  hal_bit_t* limited;
  hal_float_t* lag;
};

struct pins {
  struct axis_pins axis[VOLCOMP_AXES];
  hal_bit_t* enable;
  hal_bit_t* compensating;
  hal_u32_t* image_crc;
};

static int component;
static struct pins* pins;  // in the shared memory of HAL
static struct volcomp_machine machine;
static struct volcomp_compensator* compensation;
static union volcomp_memory memory;

// Units of HAL to those of volcomp.
static double units_per_position(size_t axis) {
  return machine.rotary[axis] ? (double)VOLCOMP_UNITS_PER_TURN / 360.0 : 1e6;
}
static double units_per_offset(size_t axis) {
  return machine.rotary[axis] ? 4294967296.0 / 360.0 : 1e6;
}

// --- realtime ------------------------------------------------------------------------------------

// To the nearest unit. False for what is no position: NaN, infinite, more than fits.
static bool to_units(double value, double scale, int64_t* units) {
  const double most = 4e18;
  const double scaled = value * scale;
  if (!(scaled > -most && scaled < most)) return false;
  *units = (int64_t)(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);
  return true;
}

static void tell_status(const struct axis_pins* axis, unsigned status) {
  // Before homing a position means nothing, and no correction follows from it.
  const bool homed = (status & VOLCOMP_NOT_HOMED) == 0;
  *axis->status = status;
  *axis->out_of_range = homed && (status & VOLCOMP_OUT_OF_RANGE) != 0;
  *axis->far_out_of_range = homed && (status & VOLCOMP_FAR_OUT_OF_RANGE) != 0;
  *axis->limited = (status & (VOLCOMP_RATE_LIMITED | VOLCOMP_ACCELERATION_LIMITED)) != 0;
}

// The largest lag grows only while an offset is held back.
static void tell_lag(void) {
  struct volcomp_diagnostics d;
  volcomp_diagnose(compensation, &d);
  for (size_t a = 0; a < machine.axes; ++a)
    *pins->axis[a].lag = d.largest_lag[a] / units_per_offset(a);
}

static void update(void* unused, long period_ns) {
  struct volcomp_input in;
  struct volcomp_output out;
  bool all_valid = true;
  bool any_limited = false;
  (void)unused;
  (void)period_ns;
  for (size_t a = 0; a < VOLCOMP_AXES; ++a) {
    struct volcomp_sample* const sample = &in.axis[a];
    sample->position = 0;
    sample->valid = sample->homed = false;
    if (a >= machine.axes) continue;
    const struct axis_pins* const axis = &pins->axis[a];
    const bool number = to_units(*axis->position, units_per_position(a), &sample->position);
    sample->valid = number && *axis->valid;
    sample->homed = *axis->homed && *pins->enable;
  }
  volcomp_tick(compensation, &in, &out);
  for (size_t a = 0; a < machine.axes; ++a) {
    const struct axis_pins* const axis = &pins->axis[a];
    *axis->offset = out.offset[a] / units_per_offset(a);
    tell_status(axis, out.status[a]);
    if ((out.status[a] & VOLCOMP_VALID) == 0) all_valid = false;
    if (*axis->limited) any_limited = true;
  }
  *pins->compensating = all_valid;
  if (any_limited) tell_lag();
}

// --- loading -------------------------------------------------------------------------------------

static int refused(const char* name, const struct volcomp_status* status) {
  const bool of_axis = status->axis != '\0';
  rtapi_print_msg(RTAPI_MSG_ERR, "volcomp: %s%s%s%s%s: %s\n", name, of_axis ? ": axis " : "",
                  of_axis ? (const char[]){status->axis, '\0'} : "",
                  status->field != NULL ? ": " : "", status->field != NULL ? status->field : "",
                  volcomp_sentence(status->reason));
  return -EINVAL;
}

static int load_image(void) {
  static unsigned char bytes[VOLCOMP_BYTES];  // no image of five axes is larger
  FILE* const file = image == NULL ? NULL : fopen(image, "rb");
  if (image == NULL) {
    rtapi_print_msg(RTAPI_MSG_ERR, "volcomp: image=FILE is missing: a table image is needed.\n");
    return -EINVAL;
  }
  if (file == NULL) {
    rtapi_print_msg(RTAPI_MSG_ERR, "volcomp: %s: the file cannot be opened.\n", image);
    return -ENOENT;
  }
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  (void)fclose(file);
  struct volcomp_status status = volcomp_create(&memory, sizeof memory, &compensation);
  if (status.reason == VOLCOMP_OK) {
    volcomp_set_time(compensation, (int64_t)time(NULL));  // expired tables are refused
    status = volcomp_stage(compensation, bytes, size, NULL);
  }
  if (status.reason != VOLCOMP_OK) return refused(image, &status);
  volcomp_describe(compensation, &machine);
  return 0;
}

// Clamped to what fits; volcomp_configure() refuses what is out of its own range.
static int32_t counts(double value) {
  if (value > 2147483647.0) return 2147483647;
  return value < 0.0 ? -1 : (int32_t)(value + 0.5);
}

// A number that only the rounding of a double keeps from being whole is whole.
static int32_t counts_down(double value) {
  return value < 1.0 ? 0 : counts(value * (1.0 + 1e-12) - 0.5);
}

static int32_t at_least_one(int32_t value) { return value == 0 ? 1 : value; }

// m/s² or rad/s². Negative: max_acceleration is no number.
static double acceleration_of(size_t axis) {
  const bool rotary = machine.rotary[axis];
  const int stated = rotary ? acceleration_mrad_per_s2 : acceleration_mm_per_s2;
  const char* const most = max_acceleration[axis];
  if (stated >= 0) return stated * 1e-3;
  if (most == NULL || *most == '\0') return rotary ? 2.0 : 0.2;
  char* end = NULL;
  const double of_axis = strtod(most, &end);
  if (*end != '\0' || !(of_axis > 0.0)) return -1.0;
  return 0.1 * of_axis * (rotary ? 6.283185307179586 / 360.0 : 1e-3);
}

// Refuses what volcomp_set_acceleration() refuses, and tells where it is coarse.
static struct volcomp_status accelerate(size_t axis, struct volcomp_axis_limits* limits) {
  const bool rotary = machine.rotary[axis];
  struct volcomp_status s =
      volcomp_set_acceleration(limits, rotary, acceleration_of(axis), period_us * 1e-6);
  s.axis = machine.letter[axis];
  if (s.reason == VOLCOMP_OK && limits->acceleration > 0 && limits->acceleration < 4)
    rtapi_print_msg(RTAPI_MSG_WARN,
                    "volcomp: axis %c: the acceleration of the offset is %d per period and period, "
                    "up to half less than stated\n",
                    machine.letter[axis], (int)limits->acceleration);
  return s;
}

// The limiter keeps room to stop within half the limit.
static void tell_effective_rate(size_t axis, const struct volcomp_axis_limits* limits) {
  const int32_t rate = volcomp_effective_rate(limits);
  if (rate >= limits->rate) return;
  const double per_second = rate / units_per_offset(axis) / (period_us * 1e-6);
  rtapi_print_msg(RTAPI_MSG_INFO, "volcomp: axis %c: offsets change by at most %g %s/s\n",
                  machine.letter[axis], per_second, machine.rotary[axis] ? "degrees" : "mm");
}

static struct volcomp_axis_limits limits_of(size_t axis) {
  const bool rotary = machine.rotary[axis];
  const double per_second = period_us * 1e-6;
  const double micro = rotary ? 4294967296.0 / 6.283185307179586e6 : 1e3;  // units per µm or µrad
  const double limit = (rotary ? limit_urad : limit_um) * micro;
  const double rate = (rotary ? rate_urad_per_s : rate_um_per_s) * micro * per_second;
  const double hysteresis = rotary ? hysteresis_nrad * 1e-3 * micro : (double)hysteresis_nm;
  struct volcomp_axis_limits l = {counts(limit), counts_down(rate), 0, counts(hysteresis), 0, 0};
  l.soft_rate = ramp_ms < 1 ? l.rate : at_least_one(counts(limit * per_second / (ramp_ms * 1e-3)));
  if (l.soft_rate > l.rate) l.soft_rate = l.rate;
  return l;
}

static int configure(void) {
  struct volcomp_settings settings;
  volcomp_default_settings(&settings);
  if (period_us < 1) {
    rtapi_print_msg(RTAPI_MSG_ERR, "volcomp: period_us must be at least 1.\n");
    return -EINVAL;
  }
  for (size_t a = 0; a < machine.axes; ++a) {
    settings.axis[a] = limits_of(a);
    const struct volcomp_status s = accelerate(a, &settings.axis[a]);
    if (s.reason != VOLCOMP_OK) return refused("settings", &s);
    tell_effective_rate(a, &settings.axis[a]);
  }
  settings.positions = actual != 0 ? VOLCOMP_ACTUAL : VOLCOMP_TARGET;
  settings.ramp_ticks = (uint32_t)at_least_one(counts(ramp_ms * 1e3 / period_us));
  struct volcomp_status status = volcomp_configure(compensation, &settings);
  if (status.reason != VOLCOMP_OK) return refused("settings", &status);
  status = volcomp_activate(compensation);
  return status.reason == VOLCOMP_OK ? 0 : refused(image, &status);
}

static int export_axis(size_t a) {
  struct axis_pins* const axis = &pins->axis[a];
  const char letter = (char)tolower((unsigned char)machine.letter[a]);
  int r = hal_pin_float_newf(HAL_IN, &axis->position, component, "volcomp.%c.position", letter);
  if (r == 0) r = hal_pin_bit_newf(HAL_IN, &axis->valid, component, "volcomp.%c.valid", letter);
  if (r == 0) r = hal_pin_bit_newf(HAL_IN, &axis->homed, component, "volcomp.%c.homed", letter);
  if (r == 0)
    r = hal_pin_float_newf(HAL_OUT, &axis->offset, component, "volcomp.%c.offset", letter);
  if (r == 0) r = hal_pin_u32_newf(HAL_OUT, &axis->status, component, "volcomp.%c.status", letter);
  if (r == 0)
    r = hal_pin_bit_newf(HAL_OUT, &axis->out_of_range, component, "volcomp.%c.out-of-range",
                         letter);
  if (r == 0)
    r = hal_pin_bit_newf(HAL_OUT, &axis->far_out_of_range, component, "volcomp.%c.far-out-of-range",
                         letter);
  if (r == 0)
    r = hal_pin_bit_newf(HAL_OUT, &axis->limited, component, "volcomp.%c.limited", letter);
  if (r == 0) r = hal_pin_float_newf(HAL_OUT, &axis->lag, component, "volcomp.%c.lag", letter);
  return r;
}

static int export_all(void) {
  int r = 0;
  pins = hal_malloc(sizeof *pins);
  if (pins == NULL) return -ENOMEM;
  for (size_t a = 0; a < machine.axes && r == 0; ++a)
    r = export_axis(a);
  if (r == 0) r = hal_pin_bit_newf(HAL_IN, &pins->enable, component, "volcomp.enable");
  if (r == 0) r = hal_pin_bit_newf(HAL_OUT, &pins->compensating, component, "volcomp.compensating");
  if (r == 0) r = hal_pin_u32_newf(HAL_OUT, &pins->image_crc, component, "volcomp.image-crc");
  if (r == 0) *pins->image_crc = machine.image_crc;
  if (r == 0) r = hal_export_funct("volcomp.update", update, NULL, 1, 0, component);
  return r;
}

int rtapi_app_main(void) {
  int r = load_image();
  if (r == 0) r = configure();
  if (r != 0) return r;
  component = hal_init("volcomp");
  if (component < 0) return component;
  r = export_all();
  if (r == 0) r = hal_ready(component);
  if (r != 0) hal_exit(component);
  return r;
}

void rtapi_app_exit(void) { hal_exit(component); }
