#!/bin/sh
# The tables of whole solves in bench/README.md, as Markdown. Usage: tables.sh BUILD_FOLDER [FOLDER_FOR_CSV]
# Some four minutes on two idle cores; with other work on the machine the ratios hold, the seconds do not.
set -eu
solve=$1/bench/solve/compare_solve
triad=$1/bench/kernels/stream_triad_bench
csv=${2:-}

table() { # NAME HEADING ARGUMENT...
  name=$1
  printf '\n### %s\n\n' "$2"
  shift 2
  "$solve" "$@" ${csv:+--csv "$csv/$name.csv"}
}

[ -z "$csv" ] || mkdir -p "$csv"
table peers 'Against the textbook' --sizes 1024 --tolerances 1e-6 --repeats 4
table tight 'Certificate 1e-8' --sizes 1024 --tolerances 1e-8 --methods double,mixed --repeats 4
table growth 'Growth with the grid' --sizes 256,512,1024,2048,4096 --tolerances 1e-8 --methods double --repeats 2
table memory 'Memory' --sizes 4096 --scenes rough_5 --methods double,mixed --repeats 2
table approach 'Approach prescribed' --scenes rough_5,rough_5_approach,rough_20,rough_20_approach,sphere,sphere_approach \
  --methods double --repeats 4
table threads 'Two threads against one (wall time)' --sizes 512,1024,2048 --scenes rough_5,sphere --methods double \
  --threads 1,2 --repeats 6
table small 'Small grids are not slowed down by threads (wall time)' --sizes 64,128 --scenes rough_5,sphere \
  --methods double --threads 1,2 --repeats 40

printf '\n### A force beside the centre\n\n'
"$1/bench/solve/compare_tilt"

printf '\n### Memory bandwidth (STREAM triad)\n\n| MB of each array | threads | GB/s |\n|--:|--:|--:|\n'
"$triad" --benchmark_format=csv --benchmark_min_time=0.3 2>/dev/null |
  awk -F, '/bm_stream_triad/ {split($1, part, "/"); gsub(/"/, "", part[3]); printf "| %s | %s | %.1f |\n", part[2], part[3], $6 / 1e9}'
