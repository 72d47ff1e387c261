#!/usr/bin/env bash
# fuzz/make_inputs.sh PROGRAM FOLDER: small valid files of every kind the program writes.
set -u
program=$1 folder=$2
"$program" sky --size 16 -o "$folder/sky.hdr"
"$program" sky --size 16 -o "$folder/sky.exr"
for encoding in rgba16f rgba32f rgb9e5 r11g11b10f; do
    "$program" bake "$folder/sky.hdr" -o "$folder/$encoding" --size 8 --levels 2 --encoding "$encoding"
done
for target in filament babylon three; do
    "$program" bake "$folder/sky.hdr" -o "$folder/$target" --for "$target" --size 16
done
