#!/usr/bin/env bash
# The Python package, built against the dev build's libraries for one Python. Closes with "python: N passed, N failed, N skipped".
#
#   run_python.sh [PYTEST-OPTION...]
#
# DOMELIGHT_PYTHON: the Python to build for (python3). The package lies in build/python/site: PYTHONPATH=build/python/site python3 uses it.
set -uo pipefail
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" && pwd)
root=$(cd -- "$here/../.." && pwd)
. "$root/scripts/build.sh"

skip() {
    printf 'skipped: the Python package: %s\npython: 0 passed, 0 failed, 1 skipped\n' "$*"
    exit 0
}
fail() {
    printf 'FAILED: %s\npython: 0 passed, 1 failed, 0 skipped\n' "$*"
    exit 1
}

build=${DOMELIGHT_BUILD:-$root/build/dev}
folder=$root/build/python
python=${DOMELIGHT_PYTHON:-python3}
mkdir -p "$folder"

# The headers of Python and its module venv, which Debian has in packages of their own.
complete='import ensurepip, pathlib, sysconfig, venv; assert pathlib.Path(sysconfig.get_path("include"), "Python.h").exists()'
if ! "$python" -c "$complete" 2>/dev/null; then
    say "installing the missing Debian packages: ${python_packages[*]}"
    apt_install "${python_packages[@]}" || skip "no ${python_packages[*]} to be had"
    "$python" -c "$complete" 2>/dev/null || skip "$python has no headers or no module venv"
fi

# A virtual environment with what the build and the tests need, and again only if that changes.
venv=$folder/venv stamp=$folder/venv/installed.txt
wanted=$("$python" -c 'import sys; print(sys.version)'; cat "$here/requirements.txt")
if [ "$(cat "$stamp" 2>/dev/null)" != "$wanted" ] || ! "$venv/bin/python" -c 'import nanobind' 2>/dev/null; then
    say "fetching nanobind, NumPy and pytest from PyPI"
    rm -rf "$venv"
    "$python" -m venv "$venv" >"$folder/pip.log" 2>&1 &&
        "$venv/bin/python" -m pip install --quiet --disable-pip-version-check -r "$here/requirements.txt" >>"$folder/pip.log" 2>&1 ||
        skip "PyPI does not serve what it needs ($(tail -n 1 "$folder/pip.log"))"
    printf '%s' "$wanted" >"$stamp"
fi

if ! cmake -S "$root" -B "$build" -DDOMELIGHT_PYTHON=ON "-DPython_EXECUTABLE=$venv/bin/python" >"$folder/configure.log" 2>&1; then
    tail -n 20 "$folder/configure.log"
    fail "configuring the Python package"
fi
if ! nice cmake --build "$build" --target domelight_python >"$folder/build.log" 2>&1; then
    tail -n 60 "$folder/build.log"
    fail "building the Python package"
fi
rm -rf "$folder/site"
cmake --install "$build" --component python --prefix "$folder/site" >"$folder/install.log" 2>&1 || fail "installing the Python package"

export DOMELIGHT_BUILD=$build PYTHONPATH=$folder/site PYTHONDONTWRITEBYTECODE=1
exec "$venv/bin/python" "$here/run_pytest.py" "$@"
