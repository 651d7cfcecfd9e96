#!/bin/sh
# Proof that the regression check works: it passes, time after time, with the library as it is, and fails, time after
# time, with a library in which one pass of the convolution is done twice (CMake's BRINELL_PLANT_SLOWDOWN).
# Usage: planted_slowdown.sh BUILD_FOLDER [TIMES]         10 times unless said otherwise
#        planted_slowdown.sh BUILD_FOLDER instructions    once, by instruction counts alone, which nothing disturbs
set -eu
build=$(CDPATH='' cd -- "$1" && pwd)
times=${2:-10}
figures='kernels:convolution_double hertz_sphere:instructions'
if [ "$times" = instructions ]; then
  times=1
  figures=hertz_sphere:instructions
fi
jobs=$(nproc 2>/dev/null || echo 2)
work=$(mktemp -d)
brinell=$build/capi/cli/brinell
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)

build_with() { # ON|OFF
  if ! { cmake -D BRINELL_PLANT_SLOWDOWN="$1" "$build" && ninja -C "$build" -j "$jobs" brinell_cli; } >"$work/log" 2>&1; then
    tail -n 20 "$work/log" >&2
    return 1
  fi
}
leave() {
  status=$?
  trap - EXIT
  build_with OFF || status=1
  rm -rf "$work"
  exit "$status"
}
trap leave EXIT
trap 'exit 130' INT TERM

build_with ON
mkdir "$work/planted"
cp "$build"/capi/libbrinell.so.[0-9] "$work/planted"
build_with OFF

check() {
  if [ "$figures" = hertz_sphere:instructions ]; then
    "$brinell" bench "$root/profiles/hertz_sphere" --baselines "$work/baselines" "$@" --rounds 0
  else
    "$brinell" bench kernels "$root/profiles/hertz_sphere" --baselines "$work/baselines" "$@"
  fi
}

printf 'recording the baseline\n'
if [ "$figures" = hertz_sphere:instructions ]; then
  check --update
else
  check --rounds 12 --update
fi
for turn in $(seq "$times"); do
  if ! check >"$work/out" 2>&1; then
    cat "$work/out"
    printf 'FAILED: turn %s of %s without the slowdown does not pass\n' "$turn" "$times"
    exit 1
  fi
done
printf 'passed %s times without the slowdown; the last time:\n' "$times"
cat "$work/out"

for turn in $(seq "$times"); do
  if LD_LIBRARY_PATH=$work/planted check >"$work/out" 2>"$work/errors"; then
    cat "$work/out"
    printf 'FAILED: turn %s of %s with the slowdown passes\n' "$turn" "$times"
    exit 1
  fi
  for figure in $figures; do
    figure="${figure%:*}: ${figure#*:}"
    if ! grep -q "$figure costs" "$work/errors"; then
      cat "$work/out" "$work/errors"
      printf 'FAILED: turn %s of %s with the slowdown does not name %s\n' "$turn" "$times" "$figure"
      exit 1
    fi
  done
done
printf '\nfailed, as it must, %s times with the slowdown; the last time:\n' "$times"
cat "$work/out" "$work/errors"
