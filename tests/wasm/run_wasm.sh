#!/usr/bin/env bash
# Builds the WebAssembly module and the npm package, and tests the package as it is packed, in a folder of its own. Closes with
# "wasm: N passed, N failed, N skipped".
set -uo pipefail
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
root=$(cd -- "$here/../.." && pwd)
. "$root/scripts/build.sh"

skip() {
    printf 'skipped: the WebAssembly module: %s\nwasm: 0 passed, 0 failed, 1 skipped\n' "$*"
    exit 0
}

need_commands nodejs npm || skip "no Node.js to be had"
mapfile -t missing < <(missing_packages "${wasm_packages[@]}")
[ ${#missing[@]} -eq 0 ] || apt_install "${missing[@]}" || skip "no ${missing[*]} to be had"
build_preset wasm

module=$root/build/wasm/domelight.wasm
folder=$root/build/npm
rm -rf "$folder"
mkdir -p "$folder/package" "$folder/app"
cp -r "$root"/npm/. "$root/LICENSE" "$root/NOTICE" "$module" "${module%.wasm}-files.wasm" "${module%.wasm}-bake.wasm" "$folder/package/"
node "$root/scripts/npm_inline.mjs" "$module" "$folder/package/inline.js"
(cd "$folder" && npm pack --silent ./package) >"$folder/pack.log" 2>&1 || { cat "$folder/pack.log"; exit 1; }
(cd "$folder/app" && npm init -y && npm install --no-audit --no-fund ../domelight-*.tgz) >"$folder/install.log" 2>&1 || { cat "$folder/install.log"; exit 1; }
cp -r "$folder/app/node_modules/domelight/test" "$folder/app/test"
cp "$here"/*.mjs "$here"/*.html "$folder/app/test/"
# The engines that the adapters are for, a bundler, and what drives the browser. Without them those tests say that they skip.
(cd "$folder/app" && npm install --ignore-scripts --no-audit --no-fund three@0.187.0 playwright-core@1.65.1 babylonjs@9.28.0 babylonjs-loaders@9.28.0 \
    playcanvas@2.23.3 deno@2.9.6 vite@8.4.0) >>"$folder/install.log" 2>&1 || say "npm does not serve the engines"

cd "$folder/app" || exit
DOMELIGHT_PROGRAM=${DOMELIGHT_PROGRAM:-$root/build/dev/cli/domelight} DOMELIGHT_MODULE=$module DOMELIGHT_ROOT=$root node --test test/*.test.mjs >"$folder/test.log" 2>&1
grep -vE '^ *(---|\.\.\.|duration_ms|type:)' "$folder/test.log"
count() { sed -nE "s/^# $1 ([0-9]+)$/\1/p" "$folder/test.log" | tail -n 1; }
printf 'wasm: %d passed, %d failed, %d skipped\n' "$(count pass)" "$(count fail)" "$(count skipped)"
[ "$(count fail)" = 0 ]
