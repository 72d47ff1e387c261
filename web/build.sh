#!/usr/bin/env bash
# Builds the browser app to build/web: the modules of the lock file from npm, fetched again only if that file changes, and then Vite.
# DOMELIGHT_WASM: the library's WebAssembly module with the readers of files (build/wasm/domelight-files.wasm); the one that bakes files lies beside it.
set -uo pipefail
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
root=$(dirname "$here")
log=$root/build/web.log
mkdir -p "$root/build"
cd "$here" || exit

if ! cmp -s package-lock.json node_modules/installed.json; then
    echo "fetching the modules of the browser app from npm" >&2
    npm ci --ignore-scripts --no-audit --no-fund >"$log" 2>&1 </dev/null || exit
    cp package-lock.json node_modules/installed.json
fi
npm run --silent build >"$log" 2>&1 </dev/null
