// Measures the machine of known_errors.h without noise: X.csv, Y.csv and Z.csv in the current
// folder.

#include <stdio.h>

#include "known_errors.h"

static void write_row(FILE* file, int axis, int direction, int target) {
  const struct known_axis* const a = &known_axes[axis];
  const double position = a->lower + (a->upper - a->lower) * target / (a->targets - 1);
  double error[6];
  known_errors(axis, position, direction, error);
  fprintf(file, "%.6f,1,%s", position, direction > 0 ? "up" : "down");
  for (int c = 0; c < 6; ++c)
    fprintf(file, ",%.5f", error[c]);
  fputs("\n", file);
}

static int write_runs(int axis) {
  const char name[] = {known_axes[axis].letter, '.', 'c', 's', 'v', '\0'};
  const int last = known_axes[axis].targets - 1;
  FILE* const file = fopen(name, "w");
  if (file == NULL) return 2;
  fputs("target [mm],run,direction", file);
  for (int c = 0; c < 6; ++c)
    fprintf(file, ",E%c%c [%s]", "XYZABC"[c], known_axes[axis].letter, c < 3 ? "um" : "urad");
  fputs("\n", file);
  for (int i = 0; i <= last; ++i)
    write_row(file, axis, 1, i);
  for (int i = last; i >= 0; --i)
    write_row(file, axis, -1, i);
  return fclose(file) == 0 ? 0 : 2;
}

int main(void) {
  int failed = 0;
  for (int axis = 0; axis < KNOWN_AXES; ++axis)
    failed |= write_runs(axis);
  return failed;
}
