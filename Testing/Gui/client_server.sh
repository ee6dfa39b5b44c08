#!/bin/bash
# Plays a session in a client, with a pvserver of one process on this computer that executes the filters.
# usage: client_server.sh PVSERVER PLUGIN_DIRECTORY PARAVIEW [ARGUMENT...]
set -u
pvserver=$1
plugins=(--plugin-search-paths="$2" --plugins=Tautline)
paraview=$3
shift 3
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
"$pvserver" "${plugins[@]}" --server-port="$port" --force-offscreen-rendering &
server=$!
trap 'kill "$server" 2>/dev/null; wait "$server" 2>/dev/null' EXIT
"$paraview" --url="cs://127.0.0.1:$port" "${plugins[@]}" "$@" # tries again until the server listens
