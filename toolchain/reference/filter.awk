# Turns the comments of a header into ones that Doxygen reads, line by line. The block below "#pragma once" describes the file; what
# begins with "---", NOLINT or IWYU is for readers of the source alone.
function text(t) {
  sub(/^\/\/+ ?/, "", t)
  gsub(/[\\@<>&#"%$]/, "\\\\&", t)
  return t
}

function for_the_source(t) { return t ~ /^\/\/ ?(---|NOLINT|IWYU|clang-format)/ }

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
