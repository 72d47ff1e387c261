#!/usr/bin/env bash
# The engines that load what domelight bakes, from npm, in headless Chromium. Closes with "engines: N passed, N failed, N skipped".
#
#   run_browser.sh [--all] [--only NAME] [--sheet FILE]
#
# --all: also the engines that take minutes without a GPU (also with DOMELIGHT_BROWSER_ENGINES=all). Pictures: build/engines/work/pictures.
set -uo pipefail
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
root=$(cd -- "$here/../../.." && pwd)
. "$root/scripts/build.sh"

skip() {
    printf 'skipped: the engines in a browser: %s\nengines: 0 passed, 0 failed, 1 skipped\n' "$*"
    exit 0
}

program=${DOMELIGHT_PROGRAM:-$root/build/dev/cli/domelight}
folder=$root/build/engines
mkdir -p "$folder"

# What the browser and Node lack, wherever Node was installed from.
need_commands "${engine_packages[@]}" || skip "no ${engine_packages[*]} to be had"

# Installs the engines of the lock file, and again only if that file changes.
if ! cmp -s "$here/package-lock.json" "$folder/installed.json"; then
    rm -f "$folder/installed.json"
    cp "$here/package.json" "$here/package-lock.json" "$folder/"
    say "fetching the engines from npm"
    (cd "$folder" && PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD=1 npm ci --ignore-scripts --no-audit --no-fund) >"$folder/npm.log" 2>&1 </dev/null ||
        skip "npm does not serve them ($(tail -n 1 "$folder/npm.log"))"
    cp "$here/package-lock.json" "$folder/installed.json"
fi

[ "${DOMELIGHT_BROWSER_ENGINES:-}" != all ] || set -- --all "$@"
exec node "$here/run.mjs" "$program" "$(command -v chromium)" "$folder/node_modules" "$folder/work" "$@"
