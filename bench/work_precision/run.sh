#!/bin/sh
# Makes pictures and tables in bench/work_precision/results anew, all or those of some profiles.
# Usage: run.sh BUILD_FOLDER [--out FOLDER] [PROFILE...], for example: run.sh build/release nanoindentation
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
program=$1/bench/work_precision/work_precision
profiles=$here/../../profiles
out=$here/results
shift
if [ "${1:-}" = --out ]; then
  out=$2
  shift 2
fi

draw() { # PROFILE ARGUMENT...
  name=$1
  shift
  "$program" "$profiles/$name" --name "$(echo "$name" | tr / _)" --out "$out" "$@"
}

sweep() { # PROFILE
  case $1 in
    hertz_sphere) draw "$1" --grids 32,64,128,256,512,1024 ;;
    afm_contact) draw "$1" --step 3 ;;
    rough_periodic) draw "$1" --step 0 --grids 256,512,1024 ;;
    profilometer) draw "$1" --step 1 ;;
    tilted_punch) draw "$1" --step 2 --grids 32,64,128,256,512 ;;
    crowned_roller | crowned_roller_gentle) draw "$1" --step 3 --grids 64,128,256,512 ;;
    # Of bodies that harden the loading alone: what follows is elastic.
    nanoindentation) draw "$1" --step 0 --rounds 1 --grids 16,24,32,48,64 --reference-grid 96 ;;
    # Up to 2 kN: plastic strain reaches 0.2 % on the way.
    two_spheres | two_spheres/one_elastic)
      draw "$1" --step 1 --rounds 2 --grids 16,24,32,48,64 --reference-grid 96
      ;;
    # Cuboids of 2 um for the tolerance and the increments.
    rough_indent)
      draw "$1" --step 0 --rounds 1 --nodes 64 --increments 3,4,6,8,12,16,24 --grids 48,64,96 --reference-grid 128
      ;;
    *)
      echo "run.sh: no sweep is known for the profile '$1'" >&2
      exit 2
      ;;
  esac
}

[ $# -gt 0 ] || set -- hertz_sphere afm_contact rough_periodic profilometer tilted_punch crowned_roller \
  crowned_roller_gentle nanoindentation two_spheres two_spheres/one_elastic rough_indent
for profile in "$@"; do sweep "$profile"; done
