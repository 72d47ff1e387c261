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

no_file() { ! "$work/build/bake_minimal" "$work/none.hdr" "$work/none.ktx2" 2>"$work/said" && grep '^error: .*none\.hdr' "$work/said"; }

claim "the library, headers, package and program install" cmake --install "$build" --prefix "$work/prefix"
claim "the installed program runs and tells the project's version" same_version
claim "the package names no folder of the build" names_no_build_folder
# A package must not depend on where it was installed first.
claim "the prefix can be moved" mv "$work/prefix" "$work/moved"
cp -r "$here/project" "$work/project"
cp "$here"/../../examples/*.cpp "$work/project"
claim "a stranger's project finds the package" \
    cmake -S "$work/project" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/moved"
claim "a stranger's project compiles and links" cmake --build "$work/build"
claim "a stranger's program runs" "$work/build/stranger"
# 32 x 16 texels of (1, 1, 1): mantissa 128, exponent 129.
{
    printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n'
    for _ in {1..512}; do printf '\200\200\200\201'; done
} >"$work/white.hdr"
claim "examples/bake_minimal.cpp bakes" "$work/build/bake_minimal" "$work/white.hdr" "$work/specular.ktx2"
# Half floats: 1.0 is 0x3c00, so a white environment leaves one value in all 6 (256^2 + ... + 16^2) texels of four channels.
claim "what it bakes of a white environment is white" \
    python3 -c 'import sys; d = open(sys.argv[1], "rb").read(); sys.exit(d.count(b"\x00\x3c") < 0.99 * 4 * 6 * sum((256 >> l) ** 2 for l in range(5)))' \
    "$work/specular.ktx2"
white_light() {
    # Under a white environment a white matte surface is white, whatever the points.
    "$work/build/sample_minimal" "$work/white.hdr" | awk '{ exit !($1 > 0.99 && $1 < 1.01 && $1 == $2 && $2 == $3) }'
}
claim "examples/sample_minimal.cpp lights a white surface white under a white sky" white_light
claim "examples/bake_minimal.cpp says what is wrong" no_file
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$work/triangle.obj"
# In floats, what arrives from above and what a white surface sends back are both 1; every file of the tour is there.
tour() {
    "$work/build/tour" "$work/white.hdr" "$work/triangle.obj" "$work/tour" >"$work/told" || return 1
    cat "$work/told"
    grep -qx 'from above comes 1 1 1' "$work/told" && [ -s "$work/tour/specular.ktx2" ] && [ -s "$work/tour/filament/manifest.json" ] &&
        [ -s "$work/tour/picture.exr" ]
}
claim "examples/tour.cpp goes through the five steps of domelight.h" tour
sed -i 's/domelight 0.1 REQUIRED/domelight 99 REQUIRED/' "$work/project/CMakeLists.txt"
claim "another version is refused" refuses_another_version

echo "install: $passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ]
