#!/usr/bin/env bash
# Installs the dev build under a new prefix and builds a stranger's project against it, with nothing else of ours in reach.
set -uo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
build=${DOMELIGHT_BUILD:-$here/../../build/dev}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0

claim() {
    local what=$1
    shift
    if "$@" >"$work/log" 2>&1; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        printf 'FAILED: %s\n' "$what"
        cat "$work/log"
    fi
}

same_version() {
    [ "$("$work/prefix/bin/domelight" --version | grep -oE '[0-9]+\.[0-9]+\.[0-9]+' | head -n 1)" = \
        "$(sed -nE 's/^project\(domelight VERSION ([0-9.]+).*/\1/p' "$here/../../CMakeLists.txt")" ]
}
names_no_build_folder() { ! grep -rnF -e "$(cd -- "$here/../.." && pwd)" "$work/prefix/lib" --include='*.cmake'; }
refuses_another_version() { ! cmake -S "$work/project" -B "$work/other" -DCMAKE_PREFIX_PATH="$work/moved"; }

claim "the library, headers, package and program install" cmake --install "$build" --prefix "$work/prefix"
claim "the installed program runs and tells the project's version" same_version
claim "the package names no folder of the build" names_no_build_folder
# A package must not depend on where it was installed first.
claim "the prefix can be moved" mv "$work/prefix" "$work/moved"
cp -r "$here/project" "$work/project"
claim "a stranger's project finds the package" \
    cmake -S "$work/project" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/moved"
claim "a stranger's project compiles and links" cmake --build "$work/build"
claim "a stranger's program runs" env -C "$work" "$work/build/stranger"
sed -i 's/domelight 0.1 REQUIRED/domelight 99 REQUIRED/' "$work/project/CMakeLists.txt"
claim "another version is refused" refuses_another_version

echo "install: $passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ]
