#!/usr/bin/env python3
"""Writes a shader in HLSL or WGSL as C++ for tests/shaders/shading_language.h: `to_cpp.py IN OUT`.

Only the declarations are rewritten; the expressions stay as they are. (GLSL needs nothing: the tests include it.)
"""

import pathlib
import re
import sys


def parameters(text):
    """`a: vec3f, b: f32` as `vec3f a, f32 b`."""
    return ", ".join("{1} {0}".format(*re.split(r"\s*:\s*", p.strip())) for p in text.split(",") if p.strip())


def hlsl(text):
    text = re.sub(r"\s*: register\(\w+\)", "", text)
    return re.sub(r"cbuffer \w+ \{(.*?)\n\};", r"\1", text, flags=re.S)


def structure(match):
    """`struct S { a: vec3f, }` as `struct S { vec3f a; };`."""
    return "struct %s {%s};" % (match[1], re.sub(r"(\w+): (\w+(?:<[^>]*>)?),", r"\2 \1;", match[2]))


def wgsl(text):
    text = re.sub(r"@group\(\d+\) @binding\(\d+\) var(?:<uniform>)? (\w+): ([^;]+);", r"\2 \1;", text)
    text = re.sub(r"^struct (\w+) \{(.*?)^\}", structure, text, flags=re.S | re.M)
    text = re.sub(r"\bfn (\w+)\(([^)]*)\) -> (\w+) \{", lambda m: f"{m[3]} {m[1]}({parameters(m[2])}) {{", text)
    text = re.sub(r"\blet (\w+) = (.*?);", r"const auto \1 = value(\2);", text, flags=re.S)
    text = re.sub(r"^const (\w+) =", r"const float \1 =", text, flags=re.M)
    return re.sub(r"\bvar (\w+) = (.*?);", r"auto \1 = value(\2);", text, flags=re.S)


source, target = map(pathlib.Path, sys.argv[1:])
target.write_text({".hlsl": hlsl, ".wgsl": wgsl}[source.suffix](source.read_text()))
