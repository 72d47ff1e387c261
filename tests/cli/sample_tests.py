"""Samples of an environment: densities, pictures, estimates, explanations."""

import json
import math
import resource
import struct

from program import files_of, make_exr, run


def csv_of(text):
    lines = text.splitlines()
    assert lines[0] == "u,v,x,y,z,r,g,b,pdf_solid_angle"
    return [[float(v) for v in line.split(",")] for line in lines[1:]]


def test_sample_draws_directions_with_their_density(folder):
    csv = csv_of(run("sample", "studio.hdr", "-n", "500", folder=folder).stdout)
    assert len(csv) == 500
    for u, v, x, y, z, r, g, b, pdf in csv:
        # The default convention: u = 1/2 + atan2(z, x) / 2 pi, v = theta / pi.
        assert abs(x * x + y * y + z * z - 1) < 1e-5 and pdf > 0 and min(r, g, b) >= 0
        assert abs(math.cos(math.pi * v) - y) < 1e-5 and abs((u - 0.5 - math.atan2(z, x) / (2 * math.pi) + 0.5) % 1 - 0.5) < 1e-5
    # The same numbers in a file, in JSON and in a file of JSON; another seed gives others.
    run("sample", "studio.hdr", "-n", "500", "-o", "s.csv", folder=folder)
    assert csv_of((folder / "s.csv").read_text()) == csv
    document = json.loads(run("sample", "studio.hdr", "-n", "500", "--json", folder=folder).stdout)
    run("sample", "studio.hdr", "-n", "500", "-o", "s.json", folder=folder)
    assert document == json.loads((folder / "s.json").read_text())
    assert document["count"] == 500 and document["method"] == "bilinear" and document["seed"] == 1
    assert [[s["u"], s["v"], *s["direction"], *s["radiance"], s["pdf_solid_angle"]] for s in document["samples"]] == csv
    assert csv_of(run("sample", "studio.hdr", "-n", "500", "--seed", "2", folder=folder).stdout) != csv
    # The mean of radiance / density is the sphere's integral, for every method, weight and sequence.
    mean = json.loads(run("info", "studio.hdr", "--json", folder=folder).stdout)["mean_radiance"][1]
    for options in [["--method", m] for m in ["linear", "walk", "binary", "guided", "alias", "hierarchical", "bilinear", "bilinear-plain"]] + \
                   [["--sequence", s] for s in ["random", "stratified", "hammersley", "halton", "r2"]] + \
                   [["--weight", "grayscale"], ["--uniform-share", "0.3"], ["--seed", "0"], ["--rotate-y-deg", "40"]]:
        csv = csv_of(run("sample", "studio.hdr", "-n", "20000", *options, folder=folder).stdout)
        integral = sum(row[6] / row[8] for row in csv) / len(csv)
        assert abs(integral / (4 * math.pi * mean) - 1) < 0.02, (options, integral, 4 * math.pi * mean)
    assert "lower bits" in run("sample", "studio.hdr", "-n", "1", "--method", "alias", "--sequence", "hammersley", folder=folder).stderr
    assert "compensated" in run("sample", "studio.hdr", "-n", "1", "--compensate", folder=folder).stderr


def test_sample_writes_pictures_and_tables(folder):
    result = run("sample", "studio.hdr", "--picture", "a.png", "--heat", "b.png", "--tables", "shader", "--picture-width", "300", folder=folder)
    assert result.stdout.splitlines() == ["a.png", "b.png", "shader/rows.ktx2", "shader/columns.ktx2", "shader/row_averages.ktx2"]
    for name in ["a.png", "b.png"]:
        assert (folder / name).read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    document = json.loads(run("sample", "studio.hdr", "--heat", "c.png", "--heat-measure", "uv", "--tables", "t", "--tables-format", "exr", "--json", folder=folder).stdout)
    assert document["files"] == ["c.png", "t/rows.exr", "t/columns.exr", "t/row_averages.exr"] and document["width"] == 64

    # Reading the tables as a shader does (docs/math/importance.md) gives the samples of the program.
    def table(name, width, height):
        info = json.loads(run("info", name, "--json", folder=folder).stdout)
        assert (info["width"], info["height"], info["levels"]) == (width, height, 1) and "R32G32" in info["format"], info
        assert info["metadata"]["domelight.weight"] == "radiant-power"
        values = struct.unpack(f"<{2 * width * height}f", (folder / name).read_bytes()[-8 * width * height:])
        return values[0::2], values[1::2]

    rows, row_pdf = table("shader/rows.ktx2", 1, 32)
    columns, column_pdf = table("shader/columns.ktx2", 64, 32)
    assert rows[-1] == 1 and all(columns[64 * j + 63] == 1 for j in range(32))
    samples = json.loads(run("sample", "studio.hdr", "-n", "64", "--sequence", "hammersley", "--seed", "0", "--method", "linear", "--json", folder=folder).stdout)["samples"]
    for i, sample in list(enumerate(samples))[1:]:  # the first lies at the pole itself
        x, y = i / 64, int(f"{i:06b}"[::-1], 2) / 64
        j = next(j for j in range(32) if rows[j] > y)
        k = next(k for k in range(64) if columns[64 * j + k] > x)
        v = (j + 1 - (rows[j] - y) * 32 / row_pdf[j]) / 32
        u = (k + 1 - (columns[64 * j + k] - x) * 64 / column_pdf[64 * j + k]) / 64
        assert abs(u - sample["u"]) < 1e-5 and abs(v - sample["v"]) < 1e-5, (u, v, sample)
        assert abs(row_pdf[j] * column_pdf[64 * j + k] / (2 * math.pi**2 * math.sin(math.pi * v)) / sample["pdf_solid_angle"] - 1) < 1e-4


def test_row_averages_draw_as_the_lecture_does(folder):
    """The lecture's loop over running row averages, then along the row of the image itself, has the density of the distribution."""
    width, height = 16, 8
    red = [20 * abs(math.sin(7 * i)) ** 4 for i in range(width * height)]
    red[37] = 900.0
    (folder / "known.exr").write_bytes(make_exr(width, height, dict(enumerate(red))))
    document = json.loads(run("sample", "known.exr", "--tables", "t", "--json", folder=folder).stdout)
    total = document["tables"]["total_average"]

    def table(name, columns, channels):
        info = json.loads(run("info", f"t/{name}.ktx2", "--json", folder=folder).stdout)
        assert (info["width"], info["height"], info["levels"]) == (columns, height, 1), info
        assert abs(float(info["metadata"]["domelight.total_average"]) / total - 1) < 1e-8
        values = struct.unpack(f"<{channels * columns * height}f", (folder / f"t/{name}.ktx2").read_bytes()[-4 * channels * columns * height:])
        return info["format"], values

    name, averages = table("row_averages", 1, 1)
    assert "R32_SFLOAT" in name, name
    light = [[(0.2126 * red[width * j + i] + 0.7874 * 0.5) * math.sin(math.pi * (j + 0.5) / height) for i in range(width)] for j in range(height)]
    for j in range(height):
        assert abs(averages[j] - sum(light[j]) / width) <= 1e-6 * total, j
    assert abs(sum(averages) / height / total - 1) < 1e-6

    def first_beyond(goal, values):
        running = 0
        for i, value in enumerate(values):
            running += value
            if running > goal:
                return i
        return len(values) - 1  # rounding at the very end

    rows, columns = table("rows", 1, 2)[1], table("columns", width, 2)[1]
    found = [[0] * width for _ in range(height)]
    n = 256
    for a in range(n):
        j = first_beyond((a + 0.5) / n * total * height, averages)
        assert j == next(j for j in range(height) if rows[2 * j] > (a + 0.5) / n)
        for b in range(n):
            i = first_beyond((b + 0.5) / n * averages[j] * width, light[j])
            assert i == next(i for i in range(width) if columns[2 * (width * j + i)] > (b + 0.5) / n)
            found[j][i] += 1
            assert b or abs(light[j][i] / total / (rows[2 * j + 1] * columns[2 * (width * j + i) + 1]) - 1) < 1e-5
    # How often a texel is found, compared with its share of the light: with the points of a grid, a strip gets at most one too many or too few.
    for j in range(height):
        row = sum(light[j]) / (total * width * height)
        for i in range(width):
            share = light[j][i] / (total * width * height)
            assert abs(found[j][i] / n**2 - share) <= (row + light[j][i] / sum(light[j])) / n + 1 / n**2, (j, i)
    # The EXR holds the same.
    run("sample", "known.exr", "--tables", "e", "--tables-format", "exr", folder=folder)
    assert b"average_weight" in (folder / "e/row_averages.exr").read_bytes()


def test_sample_explains_what_it_does(folder):
    for method in ["linear", "walk", "binary", "guided", "bilinear", "bilinear-plain"]:
        for point in [(0, 0), (0.25, 0.5), (0.999999, 0.3), (0.5, 0.97), (0.61, 0.13)]:
            words = ["sample", "studio.hdr", "--explain", f"{point[0]},{point[1]}", "--method", method]
            e = json.loads(run(*words, "--json", folder=folder).stdout)["explanation"]
            row, column, sample = e["row"], e["column"], e["sample"]
            assert row["begin"] <= row["xi"] <= row["end"] and column["begin"] <= column["xi"] <= column["end"]
            # The arithmetic of the explanation ends at the sampler's own result; rows of floats have 24 bits, which limits it under the sun.
            assert abs(row["v"] - sample["v"]) < 2e-6 and abs((column["u"] - sample["u"] + 0.5) % 1 - 0.5) < 2e-5, (method, point, e)
            assert point[1] == 0 or abs(e["pdf_solid_angle"] / sample["pdf_solid_angle"] - 1) < 2e-3, (method, point, e)
            assert abs(e["jacobian"] - 2 * math.pi**2 * math.sin(math.pi * row["v"])) < 1e-6
    text = run("sample", "studio.hdr", "--explain", "0.25,0.5", "--method", "guided", "--explain-picture", "e.png", folder=folder).stdout
    assert "<- xi is in here" in text and "2 pi^2 sin(theta)" in text and "guide table" in text and (folder / "e.png").exists()


def test_sample_estimates_agree_and_tell_the_strategies_apart(folder):
    run("sky", "-o", "dull.exr", "--exr", "float", "--height", "16", "--no-sun-disc", folder=folder)
    for surface in [["lambert"], ["phong", "--exponent", "20"], ["ggx", "--roughness", "0.5", "--metal-f0", "1,0.7,0.3"], ["charlie", "--roughness", "0.6"]]:
        for sequence in ["random", "sobol"]:
            document = json.loads(run("sample", "dull.exr", "--estimate", "--brdf", *surface, "--view", "1,1,0", "--normal", "0.2,1,-0.1", "-n", "1024",
                                      "--sequence", sequence, "--json", folder=folder).stdout)["estimate"]
            reference = document["reference"]["radiance"]
            found = {s["strategy"]: s for s in document["strategies"]}
            assert set(found) == {"riemann", "uniform", "cosine", "brdf", "environment", "mis-balance", "mis-power", "mis-balance-compensated", "product"}
            for name, s in found.items():
                for c in range(3):
                    error = abs(s["radiance"][c] - reference[c])
                    assert error < 5 * s["standard_error"][c] + 0.01 * reference[c], (surface, name, s, reference)
                assert s["convergence"][-1]["error"] == s["error"] and s["cpu_seconds"] > 0
                if s["variance"] is not None and sequence == "random":
                    # Measured over 64 runs, against the integral: within 4 standard errors of the RMS of 64 values.
                    assert abs(s["error"] / (s["variance"] / s["samples"]) ** 0.5 - 1) < 0.4, (surface, name, s)
            if sequence == "random":
                assert all(-0.75 < found[n]["slope"] < -0.3 for n in found if n != "riemann"), {n: found[n]["slope"] for n in found}
                assert abs(found["environment"]["efficiency"] - 1) < 1e-9
            else:
                assert found["cosine"]["error"] < 0.01
    few = json.loads(run("sample", "dull.exr", "--estimate", "-n", "64", "--strategy", "product,mis-power", "--json", folder=folder).stdout)["estimate"]
    assert [s["strategy"] for s in few["strategies"]] == ["environment", "mis-power", "product"] and few["gains"]["mis_compensation"] is None
    text = run("sample", "dull.exr", "--estimate", "-n", "64", "--plot", "p.png", folder=folder).stdout
    assert "MIS compensation" in text and "product by resampling" in text and "exact" in text and (folder / "p.png").exists()


def test_sample_of_constant_and_black_environments(folder):
    (folder / "flat.exr").write_bytes(make_exr(8, 4, {}))
    document = json.loads(run("sample", "flat.exr", "--estimate", "-n", "16", "--json", folder=folder).stdout)["estimate"]
    assert all(abs(v - 0.5) < 1e-6 for v in document["reference"]["radiance"])
    assert [s for s in document["strategies"] if s["strategy"] == "cosine"][0]["error"] < 1e-6
    black = make_exr(8, 4, {i: 0.0 for i in range(32)}).replace(struct.pack("<f", 0.5), struct.pack("<f", 0.0))
    (folder / "black.exr").write_bytes(black)
    for row in csv_of(run("sample", "black.exr", "-n", "50", "--heat", "h.png", "-o", "b.csv", folder=folder) and (folder / "b.csv").read_text()):
        assert all(math.isfinite(v) for v in row) and row[5:8] == [0, 0, 0] and row[8] > 0
    assert "no light" in run("sample", "black.exr", "--estimate", folder=folder, code=1).stderr


def test_sample_files_appear_whole_or_not_at_all(folder):
    (folder / "s.csv").write_text("old")

    def small_files():
        resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000))

    for words in [["-o", "s.csv", "-n", "5000"], ["--tables", "new"], ["--picture", "new.png"]]:
        result = run("sample", "studio.hdr", *words, folder=folder, code=1, preexec_fn=small_files)
        assert result.stderr.startswith("error: "), result.stderr
    assert (folder / "s.csv").read_text() == "old" and not (folder / "new").exists() and not (folder / "new.png").exists()
    expected = None
    for threads in [1, 3]:
        run("sample", "studio.hdr", "-n", "999", "-o", "s.csv", "--picture", "p.png", "--heat", "h.png", "--tables", "t", "--explain", "0.3,0.4",
            "--explain-picture", "e.png", "--threads", threads, folder=folder)
        files = files_of(folder)
        expected = expected or files
        assert files == expected


def test_numbers_of_samples_may_have_exponents(folder):
    assert run("sample", "studio.hdr", "-n", "1e3", folder=folder).stdout == run("sample", "studio.hdr", "-n", "1000", folder=folder).stdout
    for wrong in ["1.5e0", "1e-3", "1e99", "e3"]:
        assert "whole number" in run("sample", "studio.hdr", "-n", wrong, folder=folder, code=2).stderr, wrong
