#!/usr/bin/env bash
# debian_source.sh PACKAGE FOLDER: the source of a library that Debian has only compiled for the machine, in FOLDER, with Debian's corrections. It is the version that
# the program is linked with, from the mirrors that apt uses, whose signatures apt checks. The machine's own lists of packages stay as they are.
set -euo pipefail
package=$1 folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
mkdir -p "$work/lists/partial" "$work/parts" "$work/source"
touch "$work/sources.list"
for file in /etc/apt/sources.list.d/*.sources; do
    [ ! -f "$file" ] || sed 's/^Types:.*/Types: deb-src/' "$file" >"$work/parts/$(basename "$file")"
done
[ ! -f /etc/apt/sources.list ] || sed -n 's/^deb /deb-src /p' /etc/apt/sources.list >"$work/sources.list"
apt=(apt-get -qq -o Dir::State::Lists="$work/lists" -o Dir::Etc::SourceList="$work/sources.list" -o Dir::Etc::SourceParts="$work/parts" -o Dir::Cache="$work")
"${apt[@]}" update
# A mirror may lack the newest correction of security: then it is the release's own version.
(cd "$work/source" && "${apt[@]}" source "$package" >/dev/null 2>"$work/log") ||
    (rm -rf "$work/source"/* && cd "$work/source" && . /etc/os-release && "${apt[@]}" source -t "$VERSION_CODENAME" "$package" >/dev/null 2>"$work/log") ||
    { cat "$work/log" >&2; exit 1; }
mkdir -p "$(dirname "$folder")"
rm -rf "$folder"
mv "$work"/source/*/ "$folder"
