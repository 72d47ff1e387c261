#!/usr/bin/env python3
"""How the code is cut: no include goes up a layer, no folder holds more files than can be looked through, the map is true.

Closes with "house: N passed, N failed, N skipped".
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

passed = failed = 0


def claim(text, complaints):
    global passed, failed
    if complaints:
        failed += 1
        print(f"FAILED: {text}")
        print("\n".join(f"    {c}" for c in complaints))
    else:
        passed += 1


check = subprocess.run([sys.executable, ROOT / "scripts/code_map.py", "--check"], capture_output=True, text=True)
claim("the layers of the code point one way, and docs/code-map.md draws them", (check.stdout + check.stderr).splitlines())

print(f"house: {passed} passed, {failed} failed, 0 skipped")
sys.exit(1 if failed else 0)
