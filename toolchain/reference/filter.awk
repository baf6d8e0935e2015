# Turns the comments of a header into ones that Doxygen reads, line by line. The block below "#pragma once" describes the file; what
# begins with "---", NOLINT or IWYU is for readers of the source alone. The lines of a .def file in folder `root` become enumerators with
# their sentences.
function text(t) {
  sub(/^\/\/+ ?/, "", t)
  gsub(/[\\@<>&#"%$]/, "\\\\&", t)
  return t
}

function for_the_source(t) { return t ~ /^\/\/ ?(---|NOLINT|IWYU|clang-format)/ }

# Lines that are lines of another macro, too.
BEGIN {
  also["REASON"] = "LOADING|"
  also["VERDICT"] = "POINT_VERDICT|"
}

# Prints the enumerators that the lines of `file` are for `macro`.
function print_enumerators(macro, file,    line, part) {
  while ((getline line < file) > 0) {
    if (line !~ "^(" also[macro] macro ")\\(") continue
    split(line, part, /[(,] ?/)
    match(line, /"[^"]*"/)
    print "  " part[3] " = " (macro == "STATUS_BIT" ? "1U << " : "") part[2] ",  ///< " text(substr(line, RSTART + 1, RLENGTH - 2))
  }
  close(file)
}

/^#define (REASON|STATUS_BIT|VERDICT)\(/ {
  macro = substr($2, 1, index($2, "(") - 1)
  next
}

/^#include ".*\.def"$/ {
  print_enumerators(macro, root "/" substr($2, 2, length($2) - 2))
  next
}

{
  indent = $0
  sub(/[^ ].*/, "", indent)
  line = substr($0, length(indent) + 1)
  if (line ~ /^\/\// && !for_the_source(line)) {
    words = text(line)
    if (before ~ /^#(pragma once|define VOLCOMP_H)$/) words = "@file\n/// " words
    print indent "///" (words == "" ? "" : " " words)
  } else if (match($0, /  \/\/ [^"]*$/) && !for_the_source(substr($0, RSTART + 2))) {
    print substr($0, 1, RSTART + 1) "///< " text(substr($0, RSTART + 2))
  } else {
    print
  }
  before = $0
}
