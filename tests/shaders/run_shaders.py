#!/usr/bin/env python3
"""Compiles the shaders of docs/shaders with the compilers that are installed, and prints which ones it skips."""

import pathlib
import shutil
import subprocess
import sys
import tempfile

SHADERS = pathlib.Path(__file__).resolve().parents[2] / "docs" / "shaders"

# A shader is a set of functions: these lines call them. By language: the files that make one source, a `main`, and an edit that makes it wrong.
VARYING = "out vec4 colour;\nin vec3 n; in vec3 v;\n"
MAIN = {
    "glsl": [
        (["generic.glsl"], VARYING + "void main() { colour = vec4(domelight_shade(normalize(n), normalize(v), vec3(0.5), 0.2, 0.3) "
                           "+ domelight_shade_multiple_scattering(normalize(n), normalize(v), vec3(0.5), 0.2, 0.3) + domelight_diffuse_sh(normalize(n)), 1.0); }\n",
         ("roughness /", "rough /")),
        (["spherical_envmap.glsl", "latlong_split_sum.glsl"],
         VARYING + "void main() { colour = vec4(domelight_shade_latlong(normalize(n), normalize(v), vec3(0.5), 0.2, 0.3, 0.5), 1.0); }\n", ("roughness /", "rough /")),
        (["spherical_envmap.glsl", "latlong_phong.glsl"],
         VARYING + "void main() { colour = vec4(domelight_shade_phong(normalize(n), normalize(v), vec3(0.5), vec3(0.2), domelight_phong_exponent(2.5)), 1.0); }\n",
         ("rho_s *", "rho_t *")),
        (["spherical_envmap.glsl", "sample_envmap.glsl"], VARYING + "void main() { colour = vec4(diffuseBySamples(normalize(n), 64), 1.0); }\n",
         ("rest -= weight", "rest -= size")),
    ],
    "hlsl": [
        (["generic.hlsl"], "float4 main(float3 n : NORMAL, float3 v : VIEW) : SV_Target { return float4(domelight_shade(normalize(n), normalize(v), 0.5, 0.2, 0.3) "
                           "+ domelight_shade_multiple_scattering(normalize(n), normalize(v), 0.5, 0.2, 0.3) + domelight_diffuse_sh(normalize(n)), 1.0); }\n",
         ("roughness /", "rough /")),
    ],
    "wgsl": [
        (["generic.wgsl"], "@fragment fn main(@location(0) n: vec3f, @location(1) v: vec3f) -> @location(0) vec4f { return "
                           "vec4f(domelight_shade(normalize(n), normalize(v), vec3f(0.5), 0.2, 0.3) "
                           "+ domelight_shade_multiple_scattering(normalize(n), normalize(v), vec3f(0.5), 0.2, 0.3) + domelight_diffuse_sh(normalize(n)), 1.0); }\n",
         ("roughness /", "rough /")),
    ],
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
    if broken:  # a compiler that accepted everything would prove nothing
        process.returncode = 0 if process.returncode else 1
    report(name, process)


def sources(language, folder, head=""):
    """Each shader of the language as it is, and with its mistake: name, file, whether it is wrong."""
    for names, main, (right, wrong) in MAIN[language]:
        text = head + "".join((SHADERS / name).read_text() for name in names) + main
        assert right in text, (names, right)
        for words, content, broken in (("", text, False), (" with a mistake", text.replace(right, wrong, 1), True)):
            file = folder / f"{names[-1]}{words.replace(' ', '_')}.{language}"
            file.write_text(content)
            yield names[-1] + words, file, broken


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        validator = shutil.which("glslangValidator")
        for head, label in (("#version 330 core\n", "GLSL 3.30"), ("#version 300 es\nprecision highp float;\nprecision highp sampler2D;\n", "GLSL ES 3.00")):
            for words, file, broken in sources("glsl", folder, head):
                if validator:
                    compile_with(f"{label}: {words}", [validator, "-S", "frag", file], broken)
                else:
                    skip(f"{label}: {words}", "no glslangValidator")
        for words, file, broken in sources("hlsl", folder):
            if validator:
                compile_with(f"HLSL: {words}", [validator, "-D", "-V", "-S", "frag", "-e", "main", "-o", folder / "hlsl.spv", file], broken)
            else:
                skip(f"HLSL: {words}", "no glslangValidator")
        compilers = [(c, shutil.which(c)) for c in ("naga", "tint") if shutil.which(c)]
        for words, file, broken in sources("wgsl", folder):
            for compiler, path in compilers:
                compile_with(f"WGSL by {compiler}: {words}", [path, file] + (["--format", "wgsl"] if compiler == "tint" else []), broken)
            if not compilers:
                skip(f"WGSL: {words}", "neither naga nor tint")
    print(f"shaders: {passed} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0


sys.exit(main())
