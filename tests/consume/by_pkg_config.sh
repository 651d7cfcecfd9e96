#!/bin/sh
# by_pkg_config.sh PREFIX ROOT FOLDER COMPILER: builds and runs the examples, and the program of the README, against the
# library installed in PREFIX, with what pkg-config says and nothing else.
set -eu
prefix=$1 root=$2 folder=$3 compiler=$4

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name brinell.pc)")
export PKG_CONFIG_PATH
rm -rf "$folder"
mkdir -p "$folder"
awk '/^```c$/ {inside = 1; next} /^```/ {inside = 0} inside' "$root/README.md" >"$folder/readme.c"
library=$(pkg-config --variable=libdir brinell)
for source in "$root"/capi/examples/*.c "$folder/readme.c"; do
  program=$folder/$(basename "$source" .c)
  # shellcheck disable=SC2046  # flags are words
  "$compiler" -std=c99 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Wpedantic -Werror "$source" -o "$program" \
    $(pkg-config --cflags --libs brinell) -pthread -lm
  LD_LIBRARY_PATH=$library "$program"
done
