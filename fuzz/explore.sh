#!/usr/bin/env bash
# fuzz/explore.sh PROGRAM SECONDS: libFuzzer for so long, on all cores, from the seeds and from what it found before (build/corpus/NAME).
set -uo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
program=$1 name=$(basename "$1") seconds=$2
cd -- "$here/../build" || exit 1
mkdir -p "corpus/$name" crashes
seeds=$(mktemp -d)
trap 'rm -rf "$seeds"' EXIT
python3 "$here/seeds.py" "$name" "$seeds/in" || exit
if "$program" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2560 -malloc_limit_mb=1100 -max_len=262144 -fork="$(nproc)" \
    -artifact_prefix="crashes/$name-" "corpus/$name" "$seeds/in"; then
    echo "$name: 1 passed, 0 failed, 0 skipped"
else
    echo "what broke it is in build/crashes/$name-*"
    echo "$name: 0 passed, 1 failed, 0 skipped"
fi
