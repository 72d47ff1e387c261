#!/usr/bin/env bash
# fuzz/seeds.sh TARGET FOLDER: fills FOLDER with small inputs for a fuzz target: files that our program writes, in every format and
# compression, and the malformed ones of DOMELIGHT_DATA. TARGET is hdr_fuzz, exr_fuzz, ...: its first word is the file name's ending; a target
# of another name gets all of them. DOMELIGHT_PROGRAM names the built program.
set -uo pipefail
target=$1 folder=$2
case ${target%_fuzz} in
    hdr) endings=(hdr pic) ;;
    jpeg | jpg) endings=(jpg jpeg) ;;
    ktx | ktx1) endings=(ktx) ;;
    exr | png | ktx2 | dds) endings=("${target%_fuzz}") ;;
    *) endings=(hdr pic exr png jpg jpeg ktx ktx2 dds) ;;
esac
rm -rf "$folder"
mkdir -p "$folder/made"

here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
[ ! -x "${DOMELIGHT_PROGRAM:-}" ] || bash "$here/make_inputs.sh" "$DOMELIGHT_PROGRAM" "$folder/made" >/dev/null 2>&1

keep=()
for ending in "${endings[@]}"; do keep+=(-o -iname "*.$ending"); done
find "$folder/made" -type f ! \( "${keep[@]:1}" \) -delete
if [ -n "${DOMELIGHT_DATA:-}" ]; then
    # One folder, numbered: several share their names.
    n=0
    while IFS= read -r file; do
        n=$((n + 1))
        ln -s "$file" "$folder/$(printf '%04d' $n)-$(basename "$file")"
    done < <(find "$DOMELIGHT_DATA/malformed" -type f -size -1024k \( "${keep[@]:1}" \) | LC_ALL=C sort)
fi
