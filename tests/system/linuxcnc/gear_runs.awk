# Runs of the four axes of the L300G, any smooth errors, as X.csv, Y.csv, B.csv and A.csv.
BEGIN {
  write_runs("X", "mm", -100, 25, 20)
  write_runs("Y", "mm", 148.8053, 10, 20)
  write_runs("B", "deg", -59.025, 5, 12)
  write_runs("A", "deg", 0, 30, 12)
}
function write_runs(axis, unit, first, step, last,    file, down, i, at, phase, c, text) {
  file = axis ".csv"
  text = "target [" unit "],run,direction"
  for (c = 1; c <= 6; ++c)
    text = text ",E" substr("XYZABC", c, 1) axis (c < 4 ? " [um]" : " [urad]")
  print text > file
  for (down = 0; down < 2; ++down)
    for (i = 0; i <= last; ++i) {
      at = down ? last - i : i
      phase = 6.283185307 * at / last
      text = sprintf("%.7g,1,%s", first + step * at, down ? "down" : "up")
      for (c = 1; c <= 6; ++c)
        text = text sprintf(",%.3f", (4 + c) * (sin(phase + c) - sin(c)) + 0.3 * down)
      print text > file
    }
}
