#!/usr/bin/env python3
"""How the code is cut: no include goes up a layer, no folder holds more files than can be looked through, the map is true, and the English is plain.

Closes with "house: N passed, N failed, N skipped".
"""
import pathlib
import re
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


# Signs of a sentence at which a reader stops, each with what to write instead. Extend the list with what a review finds.
RIDDLES = [
    (r"\bfor (who|whoever) (write|read|compute|need|want)s\b", "say who does it: the caller, the user"),
    (r"\bas seldom\b", "say how often"),
    (r"\bto somebody else\b|\bon its way\b", "say which function does what to it"),
    (r"\bis another one\b", "say which one"),
    (r"\bdoes no harm\b", "say what the result is"),
    (r"\b(what|that) (it|they) (is|are) good for\b", "name the advantage"),
    (r"\bthrows what \w+ throws\b", "name the exceptions"),
    (r"\b(is|are) no (cube|square|lat-long|picture|whole)[- ]", "write 'is not a ...'"),
    (r"\bof its own accord\b|\bhas no say\b|\bhas a say\b", "things do not decide: say what depends on what"),
    (r"\bof one's own\b", "write 'your own'"),
]
# In comments, where the mathematics is read next to the code that computes it. (What the program prints stays ASCII.)
PLAIN_MATHEMATICS = [
    (r"\bd omega\b", "write dω"),
    (r"(?<!\w)int(_\w+|_\{[^}]*\}\S*)? [^;]{1,60}? d ?(omega|theta|phi|psi)\b", "write ∫"),
]


def lines_of(folders, endings):
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in endings and "node_modules" not in path.parts:
                for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
                    yield f"{path.relative_to(ROOT)}:{number}", line


def signs(lines, patterns):
    for place, line in lines:
        for pattern, advice in patterns:
            if found := re.search(pattern, line, re.IGNORECASE):
                yield f'{place}: "{found[0]}": {advice}'


pages = [*lines_of(["docs"], {".md"}), *((f"README.md:{n}", line) for n, line in enumerate((ROOT / "README.md").read_text().splitlines(), 1))]
code = [*lines_of(["include", "src", "cli", "bench", "examples"], {".h", ".cpp"})]
comments = [(place, line[line.index("//"):]) for place, line in [*code, *lines_of(["tests"], {".h", ".cpp"})] if "//" in line]
claim("comments, messages and pages are plain sentences", [*signs(pages, RIDDLES), *signs(code, RIDDLES)])
claim("comments hold real mathematics", [*signs(comments, PLAIN_MATHEMATICS)])

check = subprocess.run([sys.executable, ROOT / "scripts/code_map.py", "--check"], capture_output=True, text=True)
claim("the layers of the code point one way, and docs/code-map.md draws them", (check.stdout + check.stderr).splitlines())

spoken = re.compile(r'"(?:[^"\\\n]|\\.)*--[a-z](?:[^"\\\n]|\\.)*"')
claim("the library names fields, not the options of the command line",
      [f"{file.relative_to(ROOT)}:{number}: {line.strip()}" for folder in ["src", "include"]
       for file in sorted((ROOT / folder).rglob("*")) if file.suffix in (".h", ".cpp")
       for number, line in enumerate(file.read_text().splitlines(), 1)
       if spoken.search(line) and not line.lstrip().startswith("//")])
raw = re.compile(r"fmt::print\(|\b(printf|fprintf|puts|fputs)\(|std::cout|std::cerr")
claim("commands print by way of cli/console, where texts from outside are escaped",
      [f"{file.relative_to(ROOT)}:{number}: {line.strip()}" for file in sorted((ROOT / "cli").rglob("*.cpp")) if file.parent.name != "console"
       for number, line in enumerate(file.read_text().splitlines(), 1) if raw.search(line)])

every = (ROOT / "include/domelight/domelight.h").read_text()
claim("domelight.h has every public header of C++",
      [f"{name} is missing" for name in sorted(p.relative_to(ROOT / "include").as_posix() for p in (ROOT / "include").rglob("*.h"))
       if name not in ("domelight/domelight.h", "domelight/domelight_c.h") and f'#include "{name}"' not in every])

print(f"house: {passed} passed, {failed} failed, 0 skipped")
sys.exit(1 if failed else 0)
