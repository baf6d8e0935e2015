// The error motions of a machine that exists nowhere, in closed form: what its drives are commanded
// and where its tool really is differ by 57 µm. X carries the work and lies on Y; Z carries the
// tool. known_runs.c measures them, known_machine.c suffers from them; machine.toml holds the rest.
#ifndef KNOWN_ERRORS_H
#define KNOWN_ERRORS_H

#include <math.h>

enum { KNOWN_AXES = 3 };

struct known_axis {
  char letter;
  double lower, upper;  // mm
  int targets;          // of a measurement
  double scale;         // of all its errors
};

static const struct known_axis known_axes[KNOWN_AXES] = {
    {'X', 0.0, 760.0, 20, 1.0}, {'Y', 0.0, 400.0, 11, 1.3}, {'Z', -500.0, 0.0, 11, 0.7}};

// EX EY EZ in µm, EA EB EC in µrad; `direction` is 1 or −1, in which the axis arrived.
static inline void known_errors(int axis, double position, int direction, double error[6]) {
  const double turn = 6.283185307179586;
  const struct known_axis* const a = &known_axes[axis];
  const double u = (position - a->lower) / (a->upper - a->lower);
  for (int c = 0; c < 3; ++c)
    error[c] = a->scale * (c == 2 ? 8.0 * u * (1.0 - u) : 6.0 * sin(turn / 2.0 * u));
  error[axis] = a->scale * (25.0 * u + 4.0 * sin(turn * u) + 1.5 * direction);
  error[3] = a->scale * 12.0 * u;
  error[4] = a->scale * -9.0 * u * u;
  error[5] = a->scale * 15.0 * sin(turn / 4.0 * u);
}

#endif
