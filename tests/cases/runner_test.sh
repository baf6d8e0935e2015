#!/usr/bin/env bash
# The case runner itself must be able to fail: wrong values, unknown kinds, refusals that do not happen.
set -u
runner=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

# run EXIT TEXT CASE: a file with this one case.
run() {
  printf '{"format":"volcomp-cases-1","seed":"001","cases":[%s]}' "$3" >"$work/case.json"
  local output status
  output=$("$runner" "$work/case.json" 2>&1)
  status=$?
  if [ "$status" -ne "$1" ] || ! grep -qF -- "$2" <<<"$output"; then
    printf 'FAILED: wanted exit %s and "%s", got exit %s:\n%s\n' "$1" "$2" "$status" "$output"
    failed=1
  fi
}

numbers='"in":{"raw_um":40,"naive_um":20,"optimised_um":10,"squareness_arcsec":[0,0,0],"strokes":[3,4,0]}'
out='"rate_naive_percent":50,"rate_opt_percent":75,"points_gained":25,"squareness_rad":[0,0,0]'
run 0 '1 passed, 0 failed' '{"id":"a","kind":"s1.paper_numbers",'"$numbers"',"out":{'"$out"',"diagonal_mm":5},"tol":{}}'
run 1 'FAIL a  diagonal_mm: wanted 6' '{"id":"a","kind":"s1.paper_numbers",'"$numbers"',"out":{'"$out"',"diagonal_mm":6},"tol":{"diagonal_mm":0.5}}'
run 0 '1 passed' '{"id":"a","kind":"s1.paper_numbers",'"$numbers"',"out":{'"$out"',"diagonal_mm":5.4},"tol":{"diagonal_mm":0.5}}'
run 1 'absent' '{"id":"a","kind":"s1.paper_numbers",'"$numbers"',"out":{'"$out"'},"tol":{}}'
run 1 'missing' '{"id":"a","kind":"s1.paper_numbers",'"$numbers"',"out":{'"$out"',"diagonal_mm":5,"more":1},"tol":{}}'
run 1 'wanted refusal' '{"id":"a","kind":"s1.paper_numbers",'"$numbers"',"reason":"not_finite","tol":{}}'
run 1 'unknown kind' '{"id":"a","kind":"s1.nothing","in":{},"out":{},"tol":{}}'
run 1 'cannot be run' '{"id":"a","kind":"s1.paper_numbers","in":{},"out":{},"tol":{}}'
run 1 'wanted refusal "not_finite", got too_few_knots' '{"id":"a","kind":"s1.bad_input","in":{"api":"load_table","capacity":9,"axis":"X","q0":0,"h":1,"f":[[0,0,0,0,0,0]]},"reason":"not_finite","tol":{}}'
run 1 'out_where.n' '{"id":"a","kind":"s1.bad_input","in":{"api":"load_table","capacity":9,"axis":"X","q0":0,"h":1,"f":[[0,0,0,0,0,0]]},"reason":"too_few_knots","out_where":{"n":2},"tol":{}}'

printf '{"format":"other"}' >"$work/case.json"
"$runner" "$work/case.json" >/dev/null 2>&1
[ $? -eq 2 ] || { echo 'FAILED: a file of another format must end with exit 2'; failed=1; }
"$runner" "$work/none.json" >/dev/null 2>&1
[ $? -eq 2 ] || { echo 'FAILED: a missing file must end with exit 2'; failed=1; }
exit "$failed"
