# What ./run and ./test share: install what is missing, then configure and build a preset.
# All messages go to stderr, because stdout belongs to the program. Sourced with `root` set to the repository's folder.

. "$root/scripts/packages.sh"

say() { printf 'domelight: %s\n' "$*" >&2; }
die() { say "$*"; exit 1; }

# missing_packages PACKAGE...: those that dpkg does not have installed.
missing_packages() {
    local installed package
    installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p')
    for package in "$@"; do
        grep -qxF -- "$package" <<<"$installed" || printf '%s\n' "$package"
    done
}

# apt_install PACKAGE...: asks apt once, and once more after refreshing its lists. Quiet unless it fails.
apt_install() {
    local as_root=() log=$root/build/apt.log
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || return 1
        as_root=(sudo)
    fi
    local install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@")
    "${install[@]}" >"$log" 2>&1 </dev/null && return
    "${as_root[@]}" apt-get update >>"$log" 2>&1 </dev/null && "${install[@]}" >>"$log" 2>&1 </dev/null && return
    tail -n 20 "$log" >&2
    return 1
}

# need_packages NAME PACKAGE...: installs the missing ones. A stamp of the list skips the question the next time (a removed package then
# shows as a failed build, which removes the stamps).
need_packages() {
    local stamp=$root/build/packages-$1 missing
    shift
    [ "$(cat "$stamp" 2>/dev/null)" = "$*" ] && return
    mkdir -p "$root/build"
    if command -v dpkg-query >/dev/null; then
        mapfile -t missing < <(missing_packages "$@")
        if [ ${#missing[@]} -gt 0 ]; then
            say "installing the missing Debian packages: ${missing[*]}"
            if ! apt_install "${missing[@]}"; then
                say "could not install them. Please type, and then try again:"
                printf '    sudo apt-get update && sudo apt-get install %s\n' "${missing[*]}" >&2
                exit 1
            fi
        fi
    else
        say "this is not Debian: the build needs the equivalents of these packages: $*"
    fi
    printf '%s' "$*" >"$stamp"
}

# build_failed LOG WHAT: shows the whole log of a step that failed and ends. The stamps go, so that the next try looks at the packages again.
build_failed() {
    cat "$1" >&2
    rm -f "$root"/build/packages-*
    die "$2 failed; the lines above are $1"
}

# progress_text BRACKET SECONDS: "[12/340] " as "12 of 340, about 3 min left", from how long the steps so far have taken.
progress_text() {
    local done=${1#[} all left
    all=${done#*/} done=${done%%/*} all=${all%%]*}
    printf '%s of %s' "$done" "$all"
    [ "$done" -gt 9 ] && [ "$2" -gt 4 ] || return 0
    left=$(($2 * (all - done) / done))
    if [ "$left" -ge 90 ]; then printf ', about %s min left' $(((left + 30) / 60)); else printf ', about %s s left' "$left"; fi
}

# follow LOG PRESET NOTE: keeps ninja's output in LOG. Says a line at the first thing that is compiled, then how far it is and how long it
# may still take: on a terminal in place, elsewhere a line every half minute.
follow() {
    local line start=$SECONDS told=$SECONDS said=
    while IFS= read -r line; do
        printf '%s\n' "$line"
        case $line in "["*"] Building "*) ;; *) continue ;; esac
        [ -n "$said" ] || say "building ($2$3)"
        said=1
        if [ -t 2 ]; then
            printf '\r\033[K%s ' "$(progress_text "$line" $((SECONDS - start)))" >&2
        elif [ $((SECONDS - told)) -ge 30 ]; then
            say "$(progress_text "$line" $((SECONDS - start)))"
            told=$SECONDS
        fi
    done >"$1"
    [ ! -t 2 ] || [ -z "$said" ] || printf '\r\033[K' >&2
}

# build_preset PRESET [TARGET...]: brings build/PRESET up to date. Says a line only when there is something to do.
build_preset() {
    local preset=$1 folder=$root/build/$1 targets=()
    shift
    [ $# -eq 0 ] || targets=(--target "$@")
    # A copied or moved clone: CMake would refuse its old cache.
    if [ -f "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
        rm -rf "$folder"
    fi
    mkdir -p "$folder"
    # One build at a time in a folder; the lock goes with the shell that holds it.
    exec 9>"$folder.lock"
    flock 9
    if [ ! -f "$folder/build.ninja" ] || [ "$root/CMakePresets.json" -nt "$folder/build.ninja" ]; then
        say "configuring ($preset)"
        cmake -S "$root" --preset "$preset" >"$folder/configure.log" 2>&1 </dev/null ||
            build_failed "$folder/configure.log" configuring
        touch "$folder/build.ninja"
    fi
    local note=
    [ -f "$folder/.ninja_log" ] || note=": the first time takes some minutes"
    nice cmake --build "$folder" "${targets[@]}" 2>&1 </dev/null | follow "$folder/build.log" "$preset" "$note"
    [ "${PIPESTATUS[0]}" = 0 ] || build_failed "$folder/build.log" building
    exec 9>&-
}

# without_command PACKAGE...: those whose command is not there, whoever installed it.
without_command() {
    local package
    for package in "$@"; do
        command -v "${command_of[$package]:-$package}" >/dev/null || printf '%s\n' "$package"
    done
}

# need_commands PACKAGE...: installs those whose command is not there. Fails where they are not to be had.
need_commands() {
    local wanted
    mapfile -t wanted < <(without_command "$@")
    [ ${#wanted[@]} -gt 0 ] || return 0
    say "installing the missing Debian packages: ${wanted[*]}"
    apt_install "${wanted[@]}"
}

# build_app: brings the WebAssembly module and the browser app (build/web) up to date.
build_app() {
    need_commands nodejs npm || die "could not install Node.js and npm"
    need_packages wasm "${wasm_packages[@]}"
    build_preset wasm
    DOMELIGHT_WASM=$root/build/wasm/domelight-files.wasm "$root/web/build.sh" || build_failed "$root/build/web.log" "building the browser app"
}
