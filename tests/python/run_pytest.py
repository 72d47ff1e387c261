"""Runs the tests with pytest, and closes with the line that ./test reads. Arguments are passed on to pytest."""

import pathlib
import sys

import pytest


class Counts:
    """Counts results, and tells why a test was skipped."""

    def __init__(self):
        self.passed = self.failed = self.skipped = 0

    def pytest_runtest_logreport(self, report):
        if report.failed:
            self.failed += 1
        elif report.skipped:
            self.skipped += 1
            print(f"\nskipped: {report.longrepr[2].removeprefix('Skipped: ')}")
        elif report.when == "call":
            self.passed += 1

    def pytest_collectreport(self, report):
        self.failed += report.failed
        if report.skipped:
            self.skipped += 1
            print(f"\nskipped: {report.longrepr[2].removeprefix('Skipped: ')}")


if __name__ == "__main__":
    counts = Counts()
    given = sys.argv[1:]
    if not any(word.endswith(".py") or "::" in word for word in given):
        given.append(str(pathlib.Path(__file__).resolve().parent))
    status = pytest.main(["-q", "-p", "no:cacheprovider", "--durations=5", *given], plugins=[counts])
    print(f"python: {counts.passed} passed, {counts.failed} failed, {counts.skipped} skipped")
    sys.exit(status)
