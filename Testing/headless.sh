#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs a command on a virtual screen of its own. The server picks a free number itself, so that several
# can start at once; and it does not reset when its last client leaves (-noreset), so that a program that
# closes its only window and opens another is not turned away. xvfb-run -a has both weaknesses.
# usage: headless.sh COMMAND [ARGUMENT...]
set -u
number=$(mktemp)
Xvfb -displayfd 3 -screen 0 1280x1024x24 -noreset -nolisten tcp 3>"$number" 2>/dev/null &
server=$!
trap 'kill "$server" 2>/dev/null; wait "$server" 2>/dev/null; rm -f "$number"' EXIT
for _ in $(seq 200); do
  [ -s "$number" ] && break
  sleep 0.05
done
if [ ! -s "$number" ]; then
  echo "headless.sh: Xvfb did not start; is the package xvfb installed?" >&2
  exit 1
fi
DISPLAY=":$(tr -d '[:space:]' <"$number")" "$@"
