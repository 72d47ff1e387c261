#!/usr/bin/env python3
"""Tests of the program: what it writes, what it says, how it ends. DOMELIGHT_PROGRAM names it; closes with the line that ./test adds up.

    run_cli_tests.py [PART OF A NAME ...]

Each function test_... of the files beside this one gets a folder of its own, in which small environments lie ready (studio.hdr, evening.hdr).
"""

import importlib
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
from folder_tests import run_folder_tests  # noqa: E402
from program import run  # noqa: E402


def prepare(folder):
    run("sky", "-o", "studio.hdr", "--height", "32", folder=folder)
    run("sky", "-o", "evening.hdr", "--height", "32", "--sun-elevation-deg", "5", folder=folder)


if __name__ == "__main__":
    tests = {name: value for file in sorted(HERE.glob("*_tests.py")) if file.stem != Path(__file__).stem
             for name, value in vars(importlib.import_module(file.stem)).items()}
    sys.exit(run_folder_tests("cli-tests", tests, sys.argv[1:], prepare))
