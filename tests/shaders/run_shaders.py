#!/usr/bin/env python3
"""Compiles the shaders of docs/shaders with whatever compilers are here; says what it skips."""

import pathlib
import shutil
import subprocess
import sys
import tempfile

SHADERS = pathlib.Path(__file__).resolve().parents[2] / "docs" / "shaders"

# A shader is a set of functions: these call them.
MAIN = {
    "glsl": "out vec4 colour;\nin vec3 n; in vec3 v;\nvoid main() { colour = vec4(domelight_shade(normalize(n), normalize(v), vec3(0.5), 0.2, 0.3) "
            "+ domelight_diffuse_sh(normalize(n)), 1.0); }\n",
    "hlsl": "float4 main(float3 n : NORMAL, float3 v : VIEW) : SV_Target { return float4(domelight_shade(normalize(n), normalize(v), 0.5, 0.2, 0.3) "
            "+ domelight_diffuse_sh(normalize(n)), 1.0); }\n",
    "wgsl": "@fragment fn main(@location(0) n: vec3f, @location(1) v: vec3f) -> @location(0) vec4f { return "
            "vec4f(domelight_shade(normalize(n), normalize(v), vec3f(0.5), 0.2, 0.3) + domelight_diffuse_sh(normalize(n)), 1.0); }\n",
}

passed = failed = skipped = 0


def report(name, process):
    global passed, failed
    if process.returncode == 0:
        passed += 1
    else:
        failed += 1
        print(f"FAILED {name}\n{process.stdout}{process.stderr}")


def skip(name, reason):
    global skipped
    skipped += 1
    print(f"skipped: {name}: {reason}")


def compile_with(name, words, broken=False):
    process = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    if broken:  # a compiler that accepts everything proves nothing
        process.returncode = 0 if process.returncode else 1
    report(name, process)


def sources(language, folder, head=""):
    text = head + (SHADERS / f"generic.{language}").read_text() + MAIN[language]
    good, bad = folder / f"good.{language}", folder / f"bad.{language}"
    good.write_text(text)
    bad.write_text(text.replace("roughness *", "rough *", 1))
    return [("", good, False), (" with a mistake", bad, True)]


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        validator = shutil.which("glslangValidator")
        for head, label in (("#version 330 core\n", "GLSL 3.30"), ("#version 300 es\nprecision highp float;\n", "GLSL ES 3.00")):
            for words, file, broken in sources("glsl", folder, head):
                if validator:
                    compile_with(label + words, [validator, "-S", "frag", file], broken)
                else:
                    skip(label + words, "no glslangValidator")
        for words, file, broken in sources("hlsl", folder):
            if validator:
                compile_with("HLSL" + words, [validator, "-D", "-V", "-S", "frag", "-e", "main", "-o", folder / "hlsl.spv", file], broken)
            else:
                skip("HLSL" + words, "no glslangValidator")
        compilers = [(c, shutil.which(c)) for c in ("naga", "tint") if shutil.which(c)]
        for words, file, broken in sources("wgsl", folder):
            for compiler, path in compilers:
                compile_with(f"WGSL by {compiler}{words}", [path, file] + (["--format", "wgsl"] if compiler == "tint" else []), broken)
            if not compilers:
                skip("WGSL" + words, "neither naga nor tint")
    print(f"shaders: {passed} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0


sys.exit(main())
