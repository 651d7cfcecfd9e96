#!/bin/sh
# Makes all pictures and tables in bench/work_precision/results anew. Usage: run.sh BUILD_FOLDER [FOLDER]
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
program=$1/bench/work_precision/work_precision
out=${2:-$here/results}
profiles=$here/../../profiles

draw() { # PROFILE ARGUMENT...
  name=$1
  shift
  "$program" "$profiles/$name" --name "$name" --out "$out" "$@"
}

draw hertz_sphere --coarsest 32 --finest 1024
draw afm_contact --step 3
draw rough_periodic --step 0 --coarsest 256 --finest 1024
draw profilometer --step 1
