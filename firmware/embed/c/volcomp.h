#ifndef VOLCOMP_H
#define VOLCOMP_H
// The compensation for controllers written in C99: the integrated form behind plain functions. A
// table image in, then positions in and offsets out at every servo interrupt, and corrected points
// of a touch probe. Same code and same bits as the C++ class underneath.
//
//   static union volcomp_memory memory;
//   struct volcomp_compensator* compensation;
//   struct volcomp_status s = volcomp_create(&memory, sizeof memory, &compensation);
//   if (s.reason == VOLCOMP_OK) s = volcomp_stage(compensation, image, image_bytes, NULL);
//   if (s.reason == VOLCOMP_OK) s = volcomp_configure(compensation, &settings);
//   if (s.reason == VOLCOMP_OK) s = volcomp_activate(compensation);
//   if (s.reason != VOLCOMP_OK) puts(volcomp_sentence(s.reason));
//   servo interrupt:  volcomp_tick(compensation, &input, &output);
//
// No heap, no operating system, no globals, no library but the one square root of a point. Two
// contexts use a compensator: the interrupt calls volcomp_tick() and volcomp_direction(), the
// background everything else, one call at a time. The interrupt may preempt the background anywhere
// unless a function is marked "no tick may come". Two compensators share no state.
//
// Functions that can fail return a volcomp_status; where they refuse, everything is as before, and
// the tables in use stay active; the others need good pointers. The command line tool
// `volcomp build-tables` writes table images.
//
// It lies beside the other forms in firmware and not in comp: comp is C++ and includes no other
// folder; this folder includes comp only.

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  VOLCOMP_AXES = 5,           // most a machine may have; those it has not are ignored
  VOLCOMP_KNOTS = 128,        // most a table of one axis may have
  VOLCOMP_STATUS_BITS = 15,   // that an axis may show
  VOLCOMP_TEMPERATURES = 4,   // inputs for temperatures
  VOLCOMP_RADIUS_TERMS = 16,  // of the radius of a probe ball by direction
  VOLCOMP_BYTES = 134 * 1024  // of one compensator, on any processor
};

// A turn of a rotary axis in units of its position; 2^32 is one in units of its offset.
#define VOLCOMP_UNITS_PER_TURN (INT64_C(1) << 40)

// --- what can be refused -------------------------------------------------------------------------

// Those of the functions below; more may come in later versions. volcomp_code() and
// volcomp_sentence() know them all.
enum volcomp_reason {
  VOLCOMP_OK = 0,
  VOLCOMP_NOT_FINITE = 1,
  VOLCOMP_TOO_FEW_KNOTS = 12,
  VOLCOMP_TOO_MANY_KNOTS = 13,
  VOLCOMP_PITCH_NOT_POSITIVE = 14,
  VOLCOMP_TRAVEL_TOO_LONG = 15,
  VOLCOMP_NOT_PERIODIC = 16,
  VOLCOMP_BAD_MAGIC = 17,
  VOLCOMP_VERSION_UNKNOWN = 18,
  VOLCOMP_IMAGE_TRUNCATED = 19,
  VOLCOMP_CRC_MISMATCH = 20,
  VOLCOMP_MACHINE_MISMATCH = 21,
  VOLCOMP_AXES_MISMATCH = 22,
  VOLCOMP_BOUND_EXCEEDED = 23,
  VOLCOMP_CONTRACTION_EXCEEDED = 24,
  VOLCOMP_PARENT_NOT_LOWER = 25,
  VOLCOMP_NOT_ONE_ROOT = 26,
  VOLCOMP_BAD_BODY = 27,
  VOLCOMP_TOO_MANY_BODIES = 28,
  VOLCOMP_TOO_MANY_AXES = 29,
  VOLCOMP_BAD_JOINT = 30,
  VOLCOMP_NOT_A_ROTATION = 31,
  VOLCOMP_BAD_AXIS_INDEX = 32,
  VOLCOMP_NO_AUTHORITY = 33,
  VOLCOMP_BAD_SETTING = 34,
  VOLCOMP_NOT_STAGED = 38,
  VOLCOMP_HAND_OVER_PENDING = 39,
  VOLCOMP_BAD_THERMAL = 80,
  VOLCOMP_EXPIRED = 81,
  VOLCOMP_CANNOT_ORIENT = 82,
  VOLCOMP_NO_WAY = 83,
  VOLCOMP_ACCELERATION_TOO_SMALL = 84,
  // of this interface
  VOLCOMP_NULL_POINTER = 240,
  VOLCOMP_MEMORY_TOO_SMALL = 241,
  VOLCOMP_MEMORY_MISALIGNED = 242
};

struct volcomp_status {
  int reason;         // enum volcomp_reason
  char axis;          // letter of the axis concerned, or '\0'
  const char* field;  // name of the setting or argument concerned, or NULL; stays
  int index;          // knot, or number of the axis of a setting, from 0; −1: does not apply
  int channel;        // 0…5 = EX EY EZ EA EB EC; −1: does not apply
};

// Stable name for programs, for instance "crc_mismatch"; "unknown" for other numbers.
const char* volcomp_code(int reason);
// One plain sentence for people.
const char* volcomp_sentence(int reason);

// --- setting up, in the background ---------------------------------------------------------------

struct volcomp_compensator;

// Static storage for one compensator.
union volcomp_memory {
  unsigned char bytes[VOLCOMP_BYTES];
  int64_t aligned;
  double aligned_too;
};

// Needs no release: memory that is not ticked any more may be used otherwise, or given here again.
// Refuses null_pointer, memory_too_small (below VOLCOMP_BYTES), memory_misaligned (as int64_t).
struct volcomp_status volcomp_create(void* memory, size_t bytes, struct volcomp_compensator** out);

// Linear: nm; rotary: 2^-32 turn; `max_step` of a rotary axis 2^-40 turn. Whatever counts in ticks
// is set from seconds by the functions below: 10 000 nm per tick are 10 mm/s at 1 ms, but 80 mm/s
// at 125 µs.
struct volcomp_axis_limits {
  int32_t limit;       // largest |offset|, 1…4 194 303
  int32_t rate;        // largest change of it per tick, 1…1e9
  int32_t soft_rate;   // the same while an axis is lost, not homed or coming back, 1…rate
  int32_t hysteresis;  // of the direction, 0…4 194 303
  int64_t max_step;    // largest plausible |change of position| per tick; 0 = any
  // Largest change of the change per tick, 1…2^24; 0 or at least 2·rate: none. A drive that is
  // asked for more acceleration than it has to spare follows late, by micrometres.
  int32_t acceleration;
};

enum volcomp_positions {
  VOLCOMP_TARGET = 0,  // commanded: the encoder will show position + offset
  VOLCOMP_ACTUAL = 1   // of the encoder: already contains the offset
};

struct volcomp_settings {
  struct volcomp_axis_limits axis[VOLCOMP_AXES];
  int positions;              // enum volcomp_positions
  uint32_t machine_id;        // tables of another machine are refused; 0 = any
  uint32_t ramp_ticks;        // of every change of tables, 1…2^24
  uint16_t stale_drop_ticks;  // without a valid position for more ticks: correction ramped to 0
};

// What a compensator has before it is configured: rates and times of ticks of 1 ms, 10 and 1 mm/s
// (of a rotary axis 10 000 and 1 000 units of 2^-32 turn, 15 and 1.5 mrad/s), 0.2 and 0.01 s,
// whatever the period, and no bound on the acceleration.
void volcomp_default_settings(struct volcomp_settings* out);

// The four below set what counts in ticks from values per second and the period of the tick,
// `period_s`, 1e-6…1 s. Pure functions: no compensator, no memory. Where they refuse, `limits` and
// `settings` are as before and the field is named: null_pointer; bad_setting for what is no number,
// out of its range, or too small or too large for one tick. A machine at 8 kHz:
//
//   const double period_s = 125e-6;
//   s = volcomp_set_times(&settings, 0.2, 0.01, period_s);                          // 1600, 80
//   for each axis, with s checked after every line:
//     s = volcomp_set_rate(&settings.axis[a], false, 10.0, 1.0, period_s);          // 1250, 125
//     s = volcomp_set_acceleration(&settings.axis[a], false, 0.2, period_s);        // 3
//     s = volcomp_set_max_speed(&settings.axis[a], false, 500.0, period_s);         // 125 000

// Sets `acceleration` of `limits` from m/s² of a linear or rad/s² of a rotary axis, 0…1e6 (0:
// none); rounded down. At most what the drive has to spare: a tenth of the acceleration of the
// axis, or 0.2 m/s² and 2 rad/s² where that is not known. A result below 4 is coarse: up to half
// tighter than stated. Refuses acceleration_too_small, too, where less than one unit per tick and
// tick is left: 0.2 m/s² are 200 at 1 ms, 12 at 250 µs, 3 at 125 µs, and refused at 62.5 µs.
struct volcomp_status volcomp_set_acceleration(struct volcomp_axis_limits* limits, bool rotary,
                                               double acceleration, double period_s);

// Sets `rate` and `soft_rate` of `limits` from mm/s of a linear or rad/s of a rotary axis, above 0;
// rounded down, soft_rate at most rate. Usual: 10 mm/s and 0.1 rad/s; soft: limit / ramp.
struct volcomp_status volcomp_set_rate(struct volcomp_axis_limits* limits, bool rotary, double rate,
                                       double soft_rate, double period_s);

// Sets `max_step` of `limits` from the largest speed of the axis, mm/s or rad/s, 0…5e8 (0: any): a
// position that jumps by more than twice what it moves in a tick is implausible. To the nearest
// unit.
struct volcomp_status volcomp_set_max_speed(struct volcomp_axis_limits* limits, bool rotary,
                                            double max_speed, double period_s);

// Sets `ramp_ticks` and `stale_drop_ticks` from seconds, 0 or more, to the nearest number of ticks,
// 1…2^24 and 0…65 535. A ramp of less than half a tick is one of a tick.
struct volcomp_status volcomp_set_times(struct volcomp_settings* settings, double ramp_s,
                                        double stale_drop_s, double period_s);

// The largest change of an offset per tick within `limits`: `rate`, or less where stopping from it
// would take more than half of `limit` at this `acceleration`. With 0.2 mm, 10 mm/s and 0.2 m/s² at
// 1 ms: 6 425 nm, 6.4 mm/s. 0 for limits that volcomp_configure() refuses, and for NULL.
int32_t volcomp_effective_rate(const struct volcomp_axis_limits* limits);

// No tick may come. Refuses null_pointer and bad_setting with the field named.
struct volcomp_status volcomp_configure(struct volcomp_compensator* c,
                                        const struct volcomp_settings* settings);

// Checks an image and folds its tables into the spare half of the memory, for the temperatures
// known by now and for the functional point of the image or, after a change of the tool, for
// `tool_mm` (three, frame of the tool holder; NULL = that of the image). The bytes are not needed
// afterwards. Until the first activation every staged image may bring another machine, and no tick
// may come; later ones must be of the same machine. Whatever becomes of an image, one that was
// staged before it cannot be activated any more. Refuses null_pointer, not_finite,
// hand_over_pending, too_many_axes, machine_mismatch, expired and whatever can be wrong with an
// image.
struct volcomp_status volcomp_stage(struct volcomp_compensator* c, const void* image, size_t bytes,
                                    const double* tool_mm);

// Offsets the drives hold at start-up, for the first tick to go on from. After the first stage; no
// tick may come. Refuses null_pointer and bad_setting beyond ±2^30.
struct volcomp_status volcomp_start_from(struct volcomp_compensator* c,
                                         const int32_t offset[VOLCOMP_AXES]);

// The staged tables are active from the next tick on, ramped in. Refuses null_pointer, not_staged.
struct volcomp_status volcomp_activate(struct volcomp_compensator* c);

// Corrections ramp to 0 and stay there until the next volcomp_activate().
void volcomp_deactivate(struct volcomp_compensator* c);

// Checks active tables, machine and settings for bits that have changed in memory; call it from
// time to time. After a change: crc_mismatch, corrections ramp to 0 and every axis shows
// VOLCOMP_TABLE_DAMAGED.
struct volcomp_status volcomp_scrub(struct volcomp_compensator* c);

// A change waits for the next tick. / Tables are active.
bool volcomp_pending(const struct volcomp_compensator* c);
bool volcomp_active(const struct volcomp_compensator* c);
// No change waits or is being ramped in.
bool volcomp_at_rest(const struct volcomp_compensator* c);

// Describes the image accepted last.
struct volcomp_machine {
  uint32_t machine_id;
  uint32_t sequence;   // of the image, as it was built
  uint32_t image_crc;  // its closing CRC-32
  int64_t expires;     // seconds since 1970; 0: never
  float reference_C;   // temperature of the campaign
  uint32_t axes;       // 0: there was none yet
  char letter[VOLCOMP_AXES + 1];
  bool rotary[VOLCOMP_AXES];
  bool corrects[VOLCOMP_AXES];  // takes offsets, of position or to hold the tool's direction
};
void volcomp_describe(const struct volcomp_compensator* c, struct volcomp_machine* out);

// Counters that stay at their largest value; each counts how often a condition began.
struct volcomp_diagnostics {
  uint32_t ticks;
  uint32_t activations;
  uint32_t rejections;                   // of images, since the machine was adopted
  uint32_t active_crc;                   // of the image behind the active tables
  struct volcomp_status last_rejection;  // why
  uint16_t began[VOLCOMP_AXES][VOLCOMP_STATUS_BITS];
  int32_t largest[VOLCOMP_AXES];      // largest |offset| put out
  int32_t largest_lag[VOLCOMP_AXES];  // largest |wanted offset − offset|, for rate or acceleration
};
void volcomp_diagnose(const struct volcomp_compensator* c, struct volcomp_diagnostics* out);

// --- temperatures and expiry, in the background --------------------------------------------------

// A machine gets warm slowly, so the tick does not compute it: the growth of the axes is folded
// into the tables. When it has changed by enough, stage and activate the same image again:
//
//   volcomp_take_temperature(compensation, 0, sensor_C, seconds);
//   if (volcomp_growth_nm(compensation) > 50 && volcomp_at_rest(compensation)) {
//     s = volcomp_stage(compensation, image, image_bytes, tool_mm);
//     if (s.reason == VOLCOMP_OK) s = volcomp_activate(compensation);
//   }

enum volcomp_temperature {
  VOLCOMP_TEMPERATURE_UNKNOWN = 0,     // none was ever good: as at the reference of the tables
  VOLCOMP_TEMPERATURE_GOOD = 1,        //
  VOLCOMP_TEMPERATURE_STALE = 2,       // none came for too long: the last good one is used
  VOLCOMP_TEMPERATURE_IMPLAUSIBLE = 3  // the latest was rejected: the last good one is used
};

// Takes the reading of the sensor of an input, 0 ≤ input < VOLCOMP_TEMPERATURES, and its time, in
// seconds of any clock that only goes forward. Accepted from −20 to 80 °C and where it changes by
// less than 2 K, and 0.1 K more for every second since the last good one. Not a number: the sensor
// is broken.
void volcomp_take_temperature(struct volcomp_compensator* c, size_t input, float celsius,
                              uint32_t now_s);
// enum volcomp_temperature; stale when none came for more than `stale_s`.
int volcomp_temperature_state(const struct volcomp_compensator* c, size_t input, uint32_t now_s,
                              uint32_t stale_s);

// By how much at most, anywhere on the travel of an axis, the temperatures of now and those that
// the image staged last was folded for differ, nm. 0 where that was refused.
double volcomp_growth_nm(const struct volcomp_compensator* c);

// The date, seconds since 1970; 0: not known. From then on volcomp_stage() refuses images that
// have expired, but for the active one: it goes on following temperatures and tools.
void volcomp_set_time(struct volcomp_compensator* c, int64_t unix_s);
// The image accepted last is past its expiry. Its tables stay active: measure the machine again.
bool volcomp_expired(const struct volcomp_compensator* c);

// --- the tick, in the interrupt ------------------------------------------------------------------

// One axis at one instant. Linear: nm; rotary: 2^-40 turn, counted through.
struct volcomp_sample {
  int64_t position;
  bool valid;  // false: frame lost, encoder fault, not a number
  bool homed;  // referenced and enabled
};

struct volcomp_input {
  struct volcomp_sample axis[VOLCOMP_AXES];
};

struct volcomp_output {
  int32_t offset[VOLCOMP_AXES];   // to add to the command: nm, or 2^-32 turn
  uint16_t status[VOLCOMP_AXES];  // enum volcomp_status_bit
};

enum volcomp_status_bit {
  VOLCOMP_VALID = 1 << 0,                 // corrected as configured, nothing to report
  VOLCOMP_NOT_HOMED = 1 << 1,             // correction goes to 0
  VOLCOMP_STALE = 1 << 2,                 // no valid position: last correction held
  VOLCOMP_DROPPED = 1 << 3,               // stale for too long: correction ramps to 0
  VOLCOMP_IMPLAUSIBLE = 1 << 4,           // position jumped: treated as stale
  VOLCOMP_OUT_OF_RANGE = 1 << 5,          // beyond its table: corrected as at its end
  VOLCOMP_FAR_OUT_OF_RANGE = 1 << 6,      // by more than half a pitch
  VOLCOMP_CLAMPED = 1 << 7,               // limited to ±limit
  VOLCOMP_RATE_LIMITED = 1 << 8,          // limited to ±rate per tick
  VOLCOMP_DIRECTION_UNKNOWN = 1 << 9,     // not moved yet: mean of both directions
  VOLCOMP_RAMPING = 1 << 10,              // a change is being ramped in
  VOLCOMP_NO_AUTHORITY_HERE = 1 << 11,    // the correcting axes cannot act: last correction held
  VOLCOMP_NO_TABLES = 1 << 12,            // nothing active: correction 0
  VOLCOMP_TABLE_DAMAGED = 1 << 13,        // active tables changed in memory: correction ramped to 0
  VOLCOMP_ACCELERATION_LIMITED = 1 << 14  // held back by its acceleration limit
};

// Bounded, no library call. The pointers must be good.
void volcomp_tick(struct volcomp_compensator* c, const struct volcomp_input* in,
                  struct volcomp_output* out);

// Name of the lowest bit that is set, for instance "out_of_range", and the same as a phrase for
// people; "unknown" where none of the above is set.
const char* volcomp_status_code(unsigned status);
const char* volcomp_status_words(unsigned status);

// --- the probe -----------------------------------------------------------------------------------

enum volcomp_direction { VOLCOMP_FORWARD = 0, VOLCOMP_BACKWARD = 1, VOLCOMP_UNKNOWN = 2 };

// The direction in which an axis arrived where it is, 0 ≤ axis < VOLCOMP_AXES.
int volcomp_direction(const struct volcomp_compensator* c, size_t axis);

// Standard uncertainties of what goes into a point, each from 0 to 1e13.
struct volcomp_probe_uncertainty {
  double radius;                       // of the effective radius, nm
  double tool_length;                  // of the tool point along its vector from the tool frame, nm
  double correlation;                  // of these two, −1…1
  double repeatability;                // of the probe along the normal, nm
  double tables;                       // of the volumetric correction, per coordinate, nm
  double normal;                       // of the direction of the normal, rad
  double delay_s;                      // of the delay common to all axes
  double position[VOLCOMP_AXES];       // of a latched position, nm or rad
  double latch_delay_s[VOLCOMP_AXES];  // of the delay of one axis
};

struct volcomp_probe_settings {
  double delay_s;                      // from the contact to the edge of the signal, 0…0.05
  double latch_delay_s[VOLCOMP_AXES];  // from the edge to the latch of an axis, 0…0.05
  // Effective radius, nm, by the direction d (tool frame) in which the part pushes the ball: the
  // constant first, below 20 mm; then the factors of x, y, z, xy, yz, zx, x²−y², 3z²−1, x(x²−3y²),
  // y(3x²−y²), z(x²−y²), xyz, x(5z²−1), y(5z²−1), z(5z²−3) of d.
  double radius[VOLCOMP_RADIUS_TERMS];
  double rotation[9];     // of the part in the frame of the work holder, row by row
  double translation[3];  // nm, within ±10 km
  struct volcomp_probe_uncertainty uncertainty;
};

// No radius, no delay, the part in the frame of the work holder, no uncertainty.
void volcomp_default_probe_settings(struct volcomp_probe_settings* out);

// For the points from now on. Refuses null_pointer, not_finite, bad_setting, not_a_rotation.
struct volcomp_status volcomp_configure_probe(struct volcomp_compensator* c,
                                              const struct volcomp_probe_settings* settings);

// What one axis latched at the edge of the probe signal.
struct volcomp_latch {
  int64_t position;  // of the encoder, as that of a sample
  double velocity;   // units of position per second, within ±1e13
  int direction;     // enum volcomp_direction: the axis arrived in
};

struct volcomp_touch {
  uint32_t sequence;  // of the caller, appears in the point
  struct volcomp_latch axis[VOLCOMP_AXES];
};

// What was touched.
struct volcomp_feature {
  uint32_t index;    // of the caller, appears in the point
  double normal[3];  // out of the part, its frame; a unit vector, or 0: unknown
};

enum volcomp_verdict {
  VOLCOMP_POINT = 0,        // corrected
  VOLCOMP_CENTRE = 1,       // corrected; no normal: the centre of the ball
  VOLCOMP_UNCERTIFIED = 2,  // an axis stood outside its table: corrected as at its end
  VOLCOMP_UNCORRECTED = 3,  // no tables are active: nominal
  VOLCOMP_RETRACTING = 13,  // the ball was moving away from the part: no point
  VOLCOMP_NO_MACHINE = 14   // no tables were ever active, the machine is unknown: no point
};

struct volcomp_point {
  uint32_t sequence;
  uint32_t feature;
  int verdict;           // enum volcomp_verdict; the coordinates are 0 where there is no point
  int64_t machine[3];    // base frame, nm
  int64_t workpiece[3];  // frame of the part, nm
  float uncertainty[3];  // standard, of the workpiece coordinates, nm
};

// Refuses null_pointer, hand_over_pending (after a change until the next tick), not_finite,
// bad_setting (a normal neither 0 nor of length 1, a velocity or direction out of its range).
struct volcomp_status volcomp_correct_touch(const struct volcomp_compensator* c,
                                            const struct volcomp_touch* touch,
                                            const struct volcomp_feature* feature,
                                            struct volcomp_point* out);

// As volcomp_code() and volcomp_sentence().
const char* volcomp_verdict_code(int verdict);
const char* volcomp_verdict_sentence(int verdict);

#ifdef __cplusplus
}
#endif

#endif
