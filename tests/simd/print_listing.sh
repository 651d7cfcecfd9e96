#!/bin/sh
# Stands in for nm: its last argument is the listing itself.
for file in "$@"; do :; done
cat "$file"
