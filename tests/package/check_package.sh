#!/usr/bin/env bash
# Makes the Debian packages of a build, installs them in a root of Debian that has nothing else, and bakes there. Needs root, mmdebstrap and the package
# registry; takes minutes. ./test --package runs it.
#
#     check_package.sh BUILD
set -uo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
build=${1:?names a folder of a build}
work=$(mktemp -d)
root=$work/root
trap 'rm -rf --one-file-system "$work"' EXIT
passed=0 failed=0

claim() {
    local what=$1
    shift
    if "$@" >"$work/log" 2>&1; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        printf 'FAILED: %s\n' "$what"
        tail -n 40 "$work/log"
    fi
}

make_packages() { (cd "$build" && cpack -G DEB -B "$work/packages") && ls "$work"/packages/*.deb; }
package() { echo "$work"/packages/"$1"_*.deb; }
# $1 depends on $2.
depends() { dpkg-deb -f "$(package "$1")" Depends | tee /dev/stderr | grep -qE "(^|, )$2( |,|\$)"; }
does_not_need() { ! depends "$1" "$2"; }
make_root() {
    # shellcheck disable=SC1091
    mmdebstrap --quiet --variant=apt "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$root" && cp /etc/resolv.conf "$root/etc/" &&
        chroot "$root" apt-get update
}
# Installs the packages by name from the folder /packages of the root.
install_in_root() {
    mkdir -p "$root/packages" && cp "$work"/packages/*.deb "$root/packages/" && cp "$here/../../examples/c/bake.c" "$root/packages/" || return 1
    local files=() name
    for name in "$@"; do files+=("/packages/$(basename "$(package "$name")")"); done
    DEBIAN_FRONTEND=noninteractive chroot "$root" apt-get install -y --no-install-recommends "${files[@]}"
}
nothing_is_missing() {
    [ -z "$(chroot "$root" dpkg --audit)" ] && chroot "$root" ldd /usr/bin/domelight >"$work/needs" && ! grep 'not found' "$work/needs"
}
bakes() {
    chroot "$root" domelight sky -o /sky.hdr --height 64 --quiet && chroot "$root" domelight bake /sky.hdr -o /out --size 64 --quiet &&
        [ -s "$root/out/specular.ktx2" ] && [ -s "$root/out/manifest.json" ]
}
c_bakes() {
    chroot "$root" apt-get install -y --no-install-recommends gcc libc6-dev pkg-config &&
        chroot "$root" sh -c 'cc -std=c99 /packages/bake.c $(pkg-config --cflags --libs domelight_c) -o /bake && /bake /sky.hdr /c.ktx2' && [ -s "$root/c.ktx2" ]
}
goes_away() { chroot "$root" dpkg -r libdomelight-dev libdomelight-c1 domelight && [ ! -e "$root/usr/bin/domelight" ] && [ ! -e "$root/usr/include/domelight" ]; }

claim "cpack makes the packages" make_packages
claim "the program's package depends on Embree" depends domelight 'libembree3-3'
claim "the C library's does not" does_not_need libdomelight-c1 'libembree3-3'
claim "the C library's depends on OpenEXR" depends libdomelight-c1 'libopenexr-3-1-30'
claim "the development package depends on the C library" depends libdomelight-dev 'libdomelight-c1'
claim "a clean root is made" make_root
claim "the program's package installs there" install_in_root domelight
claim "with everything that it needs" nothing_is_missing
claim "and it bakes" bakes
claim "the packages for development install" install_in_root libdomelight-c1 libdomelight-dev
claim "a program in C compiles and bakes" c_bakes
claim "the packages can be removed" goes_away

echo "package: $passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ]
