#!/bin/sh
# expect_failure.sh TEXT COMMAND...: passes if the command fails and prints the text.
expected=$1
shift
output=$("$@" 2>&1) && { printf 'did not fail: %s\n' "$output"; exit 1; }
case $output in
  *"$expected"*) ;;
  *) printf 'expected "%s", got: %s\n' "$expected" "$output"; exit 1 ;;
esac
