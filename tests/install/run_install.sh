#!/usr/bin/env bash
# Installs the dev build under a new prefix and builds a user's project against it, without access to the source tree.
set -uo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
build=${DOMELIGHT_BUILD:-$here/../../build/dev}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0

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
names_no_build_folder() { ! grep -rnF -e "$(cd -- "$here/../.." && pwd)" "$work/prefix/lib" --include='*.cmake' --include='*.pc'; }
refuses_unknown_component() {
    mkdir "$work/unknown"
    sed 's/COMPONENTS core/COMPONENTS kitchen/' "$here/core/CMakeLists.txt" >"$work/unknown/CMakeLists.txt"
    ! cmake -S "$work/unknown" -B "$work/unknown/build" -DCMAKE_PREFIX_PATH="$work/moved" >"$work/unknown/said" 2>&1 &&
        grep -q 'has no component "kitchen"; it' "$work/unknown/said"
}
refuses_another_version() { ! cmake -S "$work/project" -B "$work/other" -DCMAKE_PREFIX_PATH="$work/moved"; }

no_file() { ! "$work/build/bake_minimal" "$work/none.hdr" "$work/none.ktx2" 2>"$work/said" && grep '^error: .*none\.hdr' "$work/said"; }

claim "the library, headers, package and program install" cmake --install "$build" --prefix "$work/prefix"
claim "the installed program runs and tells the project's version" same_version
claim "the package names no folder of the build" names_no_build_folder
# A package must not depend on where it was installed first.
claim "the prefix can be moved" mv "$work/prefix" "$work/moved"
cp -r "$here/everything" "$work/project"
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
    # Under a white environment a white matte surface is white, for any points.
    "$work/build/sample_minimal" "$work/white.hdr" | awk '{ exit !($1 > 0.99 && $1 < 1.01 && $1 == $2 && $2 == $3) }'
}
claim "examples/sample_minimal.cpp lights a white surface white under a white sky" white_light
claim "examples/bake_minimal.cpp says what is wrong" no_file
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$work/triangle.obj"
# As floats, the radiance from above and the radiance of a white surface are both 1; every file of the tour exists.
tour() {
    "$work/build/tour" "$work/white.hdr" "$work/triangle.obj" "$work/tour" >"$work/told" || return 1
    cat "$work/told"
    grep -qx 'from above comes 1 1 1' "$work/told" && [ -s "$work/tour/specular.ktx2" ] && [ -s "$work/tour/filament/manifest.json" ] &&
        [ -s "$work/tour/picture.exr" ]
}
claim "examples/tour.cpp goes through the five steps of domelight.h" tour

# A program that only samples and filters: neither its link line nor the program itself contains the libraries for files and ray tracing.
not_of_core='exr|Imath|Iex|embree|draco|webp|crypto|ssl|png|jpeg|zstd|astc|meshopt|fmt'
core_links_little() {
    ninja -C "$work/core" -t commands sampler | tail -n 1 >"$work/link"
    cat "$work/link"
    grep -q 'domelight_core' "$work/link" && ! grep -qiE -e "lib($not_of_core)|-l($not_of_core)" "$work/link" || return 1
    ldd "$work/core/sampler" | tee "$work/needs"
    ! grep -qiE "lib($not_of_core)" "$work/needs"
}
core_runs() {
    # A white sky of radiance 2 stays 2; every direction is as likely as any other, 1 / (4 pi).
    "$work/core/sampler" | tee "$work/printed"
    awk '{ exit !($1 > 0.0792 && $1 < 0.08 && $2 > 1.9999 && $2 < 2.0001) }' "$work/printed"
}
claim "a project that only samples and filters finds the component core" \
    cmake -S "$here/core" -B "$work/core" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/moved"
claim "it compiles and links" cmake --build "$work/core"
claim "it links Highway and threads, and none of the libraries that files and rays need" core_links_little
claim "it runs" core_runs
# The C interface, found by CMake and by pkg-config, in a program that knows nothing of C++.
cp -r "$here/c" "$work/c"
cp "$here/../../examples/c/bake.c" "$work/c"
c_bakes_the_same() { "$work/c/build/bake" "$work/white.hdr" "$work/c.ktx2" && cmp "$work/c.ktx2" "$work/specular.ktx2"; }
c_by_pkg_config() {
    local libdir
    libdir=$(dirname "$(find "$work/moved" -name libdomelight_c.so)")
    export PKG_CONFIG_PATH=$libdir/pkgconfig
    # shellcheck disable=SC2046
    cc -std=c99 "$work/c/bake.c" $(pkg-config --cflags --libs domelight_c) -Wl,-rpath,"$libdir" -o "$work/c/by_pkg_config" &&
        "$work/c/by_pkg_config" "$work/white.hdr" "$work/c2.ktx2" && cmp "$work/c2.ktx2" "$work/specular.ktx2"
}
claim "a project in C finds the component c" cmake -S "$work/c" -B "$work/c/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/moved"
claim "it compiles and links" cmake --build "$work/c/build"
claim "it bakes the bytes of examples/bake_minimal.cpp" c_bakes_the_same
claim "pkg-config finds it too" c_by_pkg_config

# What belongs to the program.
share=$work/moved/share
texts_are_there() { [ -s "$share/doc/domelight/LICENSE" ] && [ -s "$share/doc/domelight/NOTICE" ] && [ -s "$share/domelight/shaders/generic.glsl" ]; }
pages_for_all_commands() {
    "$work/moved/bin/domelight" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p' >"$work/commands"
    [ "$(wc -l <"$work/commands")" -gt 5 ] || return 1
    while read -r command; do [ -s "$share/man/man1/domelight-$command.1" ] || { echo "no page for $command"; return 1; }; done <"$work/commands"
    [ -s "$share/man/man1/domelight.1" ]
}
# Every option of the help is in the page, by its name.
page_has_options() {
    "$work/moved/bin/domelight" bake --help | grep -oE '^  (-[a-z], )?--[a-z-]+' | grep -oE -e '--[a-z-]+' >"$work/options"
    sed 's/\\-/-/g' "$share/man/man1/domelight-bake.1" >"$work/page"
    [ "$(wc -l <"$work/options")" -gt 30 ] || return 1
    while read -r option; do grep -qF -e "$option" "$work/page" || { echo "no $option"; return 1; }; done <"$work/options"
}
pages_are_set() {
    for page in "$share"/man/man1/*.1; do
        man --warnings -E UTF-8 -l "$page" 2>"$work/said" >"$work/set" || return 1
        [ ! -s "$work/said" ] || { cat "$work/said"; return 1; }
    done
}
# complete WORDS...: what bash offers for the last word.
complete() {
    bash -c '. "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); compopt() { :; }; _domelight; printf "%s\n" "${COMPREPLY[@]}"' - \
        "$share/bash-completion/completions/domelight" domelight "$@" | sort
}
bash_completes() {
    [ "$(complete co | tr '\n' ' ')" = 'compare completion convert ' ] &&
        [ "$(complete bake --lo)" = --lobe ] &&
        [ "$(complete bake --lobe '' | tr '\n' ' ')" = 'charlie ggx phong phong-plain ' ] &&
        [ "$(complete bake --for = ba)" = babylon ] &&
        [ "$(complete help ligh)" = lights ] &&
        [ -z "$(complete bake -o '')" ] && [ -z "$(complete bake --size '')" ]
}
bash_reads_it() { bash -c '. "$1" && complete -p domelight' - "$share/bash-completion/completions/domelight"; }
claim "licence, notice and shaders are installed" texts_are_there
claim "each command has a manual page" pages_for_all_commands
claim "which has every option" page_has_options
if command -v man >/dev/null; then claim "man sets the pages without a warning" pages_are_set; else
    skipped=$((skipped + 1))
    echo "skipped: man is not installed"
fi
claim "bash accepts the completion" bash_reads_it
claim "and completes commands, options and values" bash_completes

sed -i 's/domelight [0-9.]* REQUIRED/domelight 99 REQUIRED/' "$work/project/CMakeLists.txt"
claim "an unknown component is refused, and those that exist are listed" refuses_unknown_component
claim "another version is refused" refuses_another_version

echo "install: $passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ]
