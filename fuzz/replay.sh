#!/usr/bin/env bash
# fuzz/replay.sh PROGRAM [ARGS]: a replay program (built with the sanitizers) over its seeds and a few mutations of each.
set -uo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
program=$1 name=$(basename "$1")
shift
seeds=$(mktemp -d)
trap 'rm -rf "$seeds"' EXIT
python3 "$here/seeds.py" "$name" "$seeds/in" || exit
cd -- "$here/../build" || exit 1
ulimit -c 0
export ASAN_OPTIONS=${ASAN_OPTIONS:-allocator_may_return_null=1:max_allocation_size_mb=2048:detect_leaks=1}
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
# An .env holds PNG pictures, dozens of them: 4 ms a run.
runs=30000
[ "$name" != env_fuzz ] || runs=4000
timeout 300 "$program" --runs "$runs" "$@" "$seeds/in"
