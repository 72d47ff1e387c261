#!/usr/bin/env python3
"""The C interface as a program in C meets it: header, symbols, the example, memory.

Needs the dev build (DOMELIGHT_BUILD, else build/dev). Closes with "c: N passed, N failed, N skipped".
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("DOMELIGHT_BUILD", ROOT / "build/dev"))
LIBRARY = BUILD / "libdomelight_c.so"
HEADER = ROOT / "include/domelight/domelight_c.h"
STRICT = ["-pedantic", "-Wall", "-Wextra", "-Wstrict-prototypes", "-Werror"]

counts = {"passed": 0, "failed": 0, "skipped": 0}


def claim(text, holds, *shown):
    counts["passed" if holds else "failed"] += 1
    if not holds:
        print(f"FAILED: {text}", *shown, sep="\n    ")


def skip(why):
    counts["skipped"] += 1
    print(f"skipped: {why}")


def run(*words, **options):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, **options)


def compile_c(source, program, *flags):
    return run("cc", "-std=c99", *STRICT, "-O1", *flags, "-I", ROOT / "include", source, "-o", program, LIBRARY, f"-Wl,-rpath,{BUILD}")


def test_header(folder):
    source = folder / "only.c"
    source.write_text("#include <domelight/domelight_c.h>\n#include <domelight/domelight_c.h>\nint main(void) { return 0; }\n")
    for standard in ["c99", "c11", "c17"]:
        done = run("cc", f"-std={standard}", *STRICT, "-fsyntax-only", "-I", ROOT / "include", source)
        claim(f"the header is strict {standard}", done.returncode == 0, done.stderr)
    done = run("c++", "-x", "c++", "-std=c++98", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I", ROOT / "include", source)
    claim("the header is C++ 98 too", done.returncode == 0, done.stderr)


def test_symbols(folder):
    declared = set(re.findall(r"^DOMELIGHT_API .*?\b(domelight_\w+)\(", HEADER.read_text(), re.MULTILINE))
    shown = {line.split()[-1].split("@")[0] for line in run("nm", "-D", "--defined-only", LIBRARY).stdout.splitlines()} - {"DOMELIGHT_C_1"}
    claim("the library shows the functions of the header and nothing else", declared == shown and len(declared) > 50,
          f"only declared: {sorted(declared - shown)}", f"only shown: {sorted(shown - declared)}")
    number = re.search(r"DOMELIGHT_C_ABI_VERSION (\d+)", HEADER.read_text())[1]
    claim("its soname has the version of the interface", f"[libdomelight_c.so.{number}]" in run("readelf", "-d", LIBRARY).stdout)
    needs = set(re.findall(r"\(NEEDED\).*\[(.*)\]", run("readelf", "-d", LIBRARY).stdout))
    claim("it needs no library for ray tracing", not any("embree" in n or "tbb" in n for n in needs), needs)


def white_sky(file):
    """32 x 16 texels of (1, 1, 1)."""
    file.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n" + b"\x80\x80\x80\x81" * 512)


def test_example(folder):
    done = compile_c(ROOT / "examples/c/bake.c", folder / "bake")
    claim("examples/c/bake.c compiles as strict C99", done.returncode == 0, done.stderr)
    white_sky(folder / "white.hdr")
    done = run(folder / "bake", folder / "white.hdr", folder / "white.ktx2")
    claim("it bakes a white sky", done.returncode == 0, done.stderr)
    numbers = [float(n) for n in re.findall(r"\d+\.?\d*", done.stdout.splitlines()[0])] if done.stdout else []
    claim("whose irradiance on a floor is pi", len(numbers) == 3 and all(abs(n - 3.14159) < 0.01 for n in numbers), done.stdout)
    claim("and whose mean radiance is 1", "mean radiance 1 1 1" in done.stdout, done.stdout)
    done = run(folder / "bake", folder / "none.hdr", folder / "none.ktx2")
    claim("it says what is wrong with a file that is missing", done.returncode == 1 and done.stderr.startswith(f"error: {folder}/none.hdr: no such file"), done.stderr)
    data = os.environ.get("DOMELIGHT_DATA")
    photograph = pathlib.Path(data or "") / "env_latlong/noon_grass_1k.hdr"
    if data and photograph.exists():
        done = run(folder / "bake", photograph, folder / "noon.ktx2")
        claim("it bakes a photograph", done.returncode == 0 and (folder / "noon.ktx2").stat().st_size > 4_000_000, done.stderr)
        info = run(BUILD / "cli/domelight", "info", folder / "noon.ktx2")
        claim("as a cube that the program describes", info.returncode == 0 and "256" in info.stdout, info.stdout, info.stderr)
    else:
        skip("DOMELIGHT_DATA has no env_latlong/noon_grass_1k.hdr")


def test_memory(folder):
    done = compile_c(ROOT / "tests/c/soak.c", folder / "soak")
    claim("tests/c/soak.c compiles as strict C99", done.returncode == 0, done.stderr)
    done = run(folder / "soak", 400)
    found = re.match(r"(\d+) calls, (-?\d+) KiB more", done.stdout)
    claim("10 000 calls, right and wrong ones, are answered as they should be", done.returncode == 0 and found and int(found[1]) > 10_000,
          done.stdout, done.stderr)
    # Of 400 rounds each makes and frees some 300 KiB: a round's leak of 5 KiB would show.
    claim("and leave no more than 2 MiB of memory in use", found and int(found[2]) < 2 << 10, done.stdout)
    if shutil.which("valgrind"):
        done = run("valgrind", "-q", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect", folder / "soak", 1)
        claim("valgrind finds neither a wrong access nor a leak", done.returncode == 0, done.stderr[-4000:])
    else:
        skip("valgrind is not installed")


with tempfile.TemporaryDirectory() as name:
    for test in [test_header, test_symbols, test_example, test_memory]:
        test(pathlib.Path(name))
print(f"c: {counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
sys.exit(1 if counts["failed"] else 0)
