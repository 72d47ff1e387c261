#!/usr/bin/env bash
# openexr_source.sh FOLDER: OpenEXR's source in FOLDER (with libdeflate, which comes with it), from its source distribution on PyPI, checked by its hash.
# The WebAssembly module decodes .exr by its C library, which Debian 12 has only compiled for the machine.
set -euo pipefail
version=3.5.3
sha256=5645cc5493802832860a715ceb621139b44ee867084cec1501a2b8685e40d88a
folder=$1
[ -f "$folder/src/lib/OpenEXRCore/openexr.h" ] && exit
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# pip asks a source distribution's build system for its metadata. This one answers, so that the real one need not be installed.
mkdir -p "$work/stub/scikit_build_core"
cat >"$work/stub/scikit_build_core/build.py" <<'END'
import pathlib


def prepare_metadata_for_build_wheel(folder, config_settings=None):
    info = pathlib.Path(folder) / "openexr-0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: openexr\nVersion: VERSION\n".replace("VERSION", "3.5.3"))
    return info.name


def build_wheel(*args, **kwargs):
    raise SystemExit("only the source is wanted")
END
touch "$work/stub/scikit_build_core/__init__.py"
PYTHONPATH=$work/stub python3 -m pip download --quiet --no-deps --no-build-isolation --no-binary :all: --dest "$work" "openexr==$version"
printf '%s  %s\n' "$sha256" "$work/openexr-$version.tar.gz" | sha256sum --check --quiet
mkdir -p "$folder"
tar -xzf "$work/openexr-$version.tar.gz" -C "$folder" --strip-components 1
