#!/usr/bin/env bash
# The browser app in headless Chromium. Closes with "web: N passed, N failed, N skipped".
#
#   run_web.sh [--all] [NAME...]
#
# --all: every texture of reflection mapping, and every strategy (also with DOMELIGHT_BROWSER_ENGINES=all). NAME: only the
# tests whose names have one of these words. Pictures: build/web-test.
set -uo pipefail
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
root=$(cd -- "$here/../.." && pwd)
. "$root/scripts/build.sh"

skip() {
    printf 'skipped: the browser app: %s\nweb: 0 passed, 0 failed, 1 skipped\n' "$*"
    exit 0
}

need_commands "${web_packages[@]}" || skip "no ${web_packages[*]} to be had"

export DOMELIGHT_WASM=${DOMELIGHT_WASM:-$root/build/wasm/domelight-files.wasm}
[ -f "$DOMELIGHT_WASM" ] || skip "the WebAssembly module has not been built ($DOMELIGHT_WASM)"
"$root/web/build.sh" || skip "it cannot be built ($(tail -n 1 "$root/build/web.log"))"
[ "${DOMELIGHT_BROWSER_ENGINES:-}" != all ] || set -- --all "$@"
exec node "$here/run.mjs" "${DOMELIGHT_PROGRAM:-$root/build/dev/cli/domelight}" "$(command -v chromium)" "$@"
