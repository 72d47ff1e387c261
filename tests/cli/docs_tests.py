"""docs/lectures.md: what it names is there, and its commands run."""

import re
import shlex

from program import ROOT, TINY, run

PAGE = (ROOT / "docs/lectures.md").read_text()
ROWS = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in PAGE.splitlines() if line.startswith("| ") and "`" in line]
WORDS = {"ENV": "studio.hdr", "OUT": "out.hdr", "SCENE": "spheres", "DIR": "set"}
# What makes each command small, and what a row leaves out.
SMALL = {"bake": ["--size", "8", "--irradiance-size", "4", "--brdf-size", "16", "--no-preview"], "render": [*TINY, "--env", "studio.hdr", "-o", "picture.png"],
         "probes": ["--grid", "2,1,1", "--size", "8", "--spp", "2"], "brdf": [], "convert": [], "sample": []}


def quoted(cell):
    return re.findall(r"`([^`]*)`", cell)


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def test_docs_lectures_names_what_is_there(folder):
    assert len(ROWS) >= 15
    for target in re.findall(r"\]\(([^)]*)\)", PAGE):
        name, _, part = target.partition("#")
        path = ROOT / "docs" / name
        assert path.exists(), target
        assert not part or part in [anchor(h) for h in re.findall(r"^#+ (.*)$", path.read_text(), re.MULTILINE)], target
    lessons = re.findall(r"name: '([^']*)'", (ROOT / "web/learn/common/lessons.ts").read_text())
    named = [quoted(row[3])[0] for row in ROWS]
    assert set(named) == set(lessons), "each page has a row, and no other is named"
    for row in ROWS:
        files = [ROOT / f for f in quoted(row[2]) if "/" in f] + [ROOT / "docs" / f for f in re.findall(r"\]\(([^)]*)\)", row[2])]
        files += [files[0].parent / f for f in quoted(row[2]) if f.endswith(".glsl") and "/" not in f and files]
        assert files and all(f.exists() for f in files), row[2]
        text = "".join(f.read_text() for f in files)
        for symbol in quoted(row[2]):
            assert "." in symbol or symbol + "(" in text, f"{symbol} is not in {row[2]}"


def test_docs_lectures_commands_run(folder):
    run("probes", "spheres", "--env", "studio.hdr", "-o", "set", *SMALL["probes"], folder=folder)
    commands = [c for row in ROWS for part in quoted(row[1]) for c in [part] if c.split()[0] in SMALL]
    assert len(commands) >= 15
    for k, command in enumerate(dict.fromkeys(commands)):
        kind, *words = [WORDS.get(word, f"out{k}" if word == "out" else word) for word in shlex.split(command)]
        if "--study" in words:
            continue  # it takes minutes; render_tests.py has it
        small = list(SMALL[kind])
        if kind == "render":
            words = ["spheres", *words]
        for option in [w for w in small if w.startswith("--") and w in words]:  # what the row says counts
            at = small.index(option)
            del small[at:at + 2]
        run(kind, *words, *small, folder=folder)
