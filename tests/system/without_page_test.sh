#!/usr/bin/env bash
# Without node's packages the project configures, and the program does everything but pages, which it refuses before it
# computes anything, in one line that says what to do.
#
#   without_page_test.sh VOLCOMP_WITHOUT_PAGE SOURCE_FOLDER
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
remedy='built without the page of its reports; run toolchain/setup.sh'

mkdir "$work/copy"
tar -C "$source_dir" -cf - --exclude=./build --exclude=./.git --exclude=node_modules . | tar -C "$work/copy" -xf -
expect 0 'volcomp will refuse --report and --serve' cmake -S "$work/copy" --preset package
expect 0 'no_page.cpp' ninja -C "$work/copy/build/package" -t inputs volcomp_report

expect 2 "$remedy" "$volcomp" run xyfz --draws 0 --report "$work/report"
one_line "$volcomp" run xyfz --draws 0 --report "$work/report"
one_line "$volcomp" run xyfz --draws 0 --serve 0
expect 2 "--serve: this program was $remedy" "$volcomp" run xyfz --draws 0 --serve 0
maps=$(find "$source_dir/docs/examples" -name '*.csv' | sort | head -n 1)
expect 2 "--report: this program was $remedy" "$volcomp" compare "$maps" "$maps" --report "$work/report"
[ ! -e "$work/report" ] || { echo 'FAILED: a report was begun'; failed=1; }

expect 0 'PASS' "$volcomp" run xyfz --draws 0 --json "$work/figures.json"
[ -s "$work/figures.json" ] || { echo 'FAILED: there are no figures'; failed=1; }
exit "$failed"
