"""Runs functions that test the program, each in a folder of its own."""

import shutil
import sys
import tempfile
import time
import traceback
from pathlib import Path


class Skipped(Exception):
    """What a test raises when something that it needs is missing; the reason is its text."""


def run_folder_tests(label, functions, words, prepare):
    """Runs each function test_NAME(folder) of `functions` ({name: anything}) whose name has one of `words` in it, or all without words.
    `prepare(folder)` fills a folder of which each test gets a copy. Prints a line for each test, and last
    "LABEL: N passed, N failed, N skipped". Returns the exit status."""
    tests = [(name, test) for name, test in functions.items() if name.startswith("test_") and (not words or any(w in name for w in words))]
    passed = failed = skipped = 0
    with tempfile.TemporaryDirectory(prefix=f"domelight-{label}-") as base:
        seeds = Path(base) / "seeds"
        seeds.mkdir()
        prepare(seeds)
        for name, test in tests:
            folder = Path(base) / name
            shutil.copytree(seeds, folder)
            start = time.monotonic()
            try:
                test(folder)
                passed += 1
                print(f"passed: {name} ({time.monotonic() - start:.1f} s)", flush=True)
            except Skipped as why:
                skipped += 1
                print(f"skipped: {why}", flush=True)
            except Exception:
                failed += 1
                print(f"FAILED: {name}", flush=True)
                traceback.print_exc(file=sys.stdout)
            shutil.rmtree(folder, ignore_errors=True)
    print(f"{label}: {passed} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0
