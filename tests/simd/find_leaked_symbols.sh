#!/bin/sh
# find_leaked_symbols.sh NM OBJECT...: fails if an object of an instruction set (isa_* in its name) defines, as a
# global or weak symbol, what any other object defines too. With two definitions the linker keeps either, so that
# code for one instruction set could run in place of another's. A reference to the compiler's personality routine
# (DW.ref.*) is data that is the same everywhere.
set -eu
nm=$1
shift
listing=$(
  for object in "$@"; do
    printf 'object %s\n' "$object"
    "$nm" -P -g --defined-only "$object"
  done
)
printf '%s\n' "$listing" | awk '
  $1 == "object" {
    object = substr($0, 8)
    file = object; sub(/.*\//, "", file)
    of_isa = file ~ /^isa_/
    next
  }
  $1 ~ /^DW\.ref\./ { next }
  {
    if (of_isa) { kernels[object] = 1; of_kernels[$1] = 1 }
    objects[$1] = objects[$1] " " object
    count[$1]++
  }
  END {
    for (object in kernels) found++
    if (!found) { print "no object of an instruction set defines anything"; exit 1 }
    for (symbol in of_kernels) if (count[symbol] > 1) { print "leaked: " symbol " in" objects[symbol]; leaks++ }
    if (leaks) exit 1
    print found " objects of instruction sets share no symbol"
  }'
