#!/bin/sh
# Read by .ci/run and .ci/full: step NAME COMMAND... carries out one step and counts its tests, or one where it has none;
# finish prints the sum and is the verdict.
logs=build/ci
mkdir -p "$logs"
passed=0
failed=0

step() {
  name=$1
  shift
  printf '\n==== %s: %s\n' "$name" "$*"
  started=$(date +%s)
  { "$@" </dev/null 2>&1; echo $? >"$logs/status"; } | tee "$logs/$name.log"
  counts=$(sed -n 's/^[0-9]*% tests passed, \([0-9]*\) tests failed out of \([0-9]*\)$/\1 \2/p' "$logs/$name.log" |
    awk '{f += $1; t += $2} END {if (NR) print f, t - f}')
  if [ -n "$counts" ]; then
    failed=$((failed + ${counts% *}))
    passed=$((passed + ${counts#* }))
  fi
  if [ "$(cat "$logs/status")" = 0 ]; then
    [ -n "$counts" ] || passed=$((passed + 1))
  elif [ -z "$counts" ] || [ "${counts% *}" = 0 ]; then # it failed elsewhere than in a test
    failed=$((failed + 1))
  fi
  printf '==== %s: %s s\n' "$name" "$(($(date +%s) - started))"
}

finish() {
  printf '\n%s passed, %s failed\n' "$passed" "$failed"
  [ "$failed" = 0 ]
}
