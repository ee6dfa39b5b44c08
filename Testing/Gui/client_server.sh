#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Plays a session in a client, with a pvserver on this computer that executes the filters: of one process, or of as many
# as the environment variable TAUTLINE_SERVER_RANKS has, started by mpirun (without it the test is skipped, with 77).
# usage: client_server.sh PVSERVER PLUGIN_DIRECTORY PARAVIEW [ARGUMENT...]
set -uo pipefail
pvserver=$1
plugins=(--plugin-search-paths="$2" --plugins=Tautline)
paraview=$3
shift 3
launcher=()
if [ -n "${TAUTLINE_SERVER_RANKS:-}" ]; then
  if ! command -v mpirun >/dev/null; then
    echo "there is no mpirun"
    exit 77
  fi
  export OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_mpi_yield_when_idle=1
  launcher=(mpirun --oversubscribe --bind-to none -np "$TAUTLINE_SERVER_RANKS")
fi
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
TAUTLINE_METRICS="${TAUTLINE_SERVER_METRICS:-}" "${launcher[@]}" "$pvserver" "${plugins[@]}" --server-port="$port" --force-offscreen-rendering &
server=$!
trap 'kill "$server" 2>/dev/null; wait "$server" 2>/dev/null' EXIT
# tries again until the server listens
"$(dirname "$0")/play_sessions.sh" "$paraview" --url="cs://127.0.0.1:$port" "${plugins[@]}" "$@"
