#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs a client that plays sessions joined by join_sessions.py. Also fails if the client ends without an error before
# the last event.
# usage: play_sessions.sh PARAVIEW [ARGUMENT...]
set -uo pipefail
output=$(mktemp)
trap 'rm -f "$output"' EXIT
"$@" | tee "$output" || exit
if ! grep -q "All sessions ended" "$output"; then
  echo "play_sessions.sh: the client ended before the last event of the sessions" >&2
  exit 1
fi
