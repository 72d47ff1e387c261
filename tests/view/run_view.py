#!/usr/bin/env python3
"""`domelight view` as a browser and as an attacker meet it: what is served, what is refused, and the stream of path-traced pictures, which must be the
picture of `domelight render`. DOMELIGHT_PROGRAM names the program.

    run_view.py [WORD ...]     only tests whose name has one of the words in it
"""

import contextlib
import http.client
import json
import os
import signal
import socket
import struct
import subprocess
import sys
import time
import urllib.parse
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests")]
from folder_tests import run_folder_tests  # noqa: E402

PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
VIEW = {"position": [1.5, 1, 2], "target": [0, 0, 0], "fov_y_deg": 40, "width": 48, "height": 32, "samples": 64}


def prepare(folder):
    """A page, an environment, and a scene of one triangle with its buffer beside it."""
    (folder / "app/assets").mkdir(parents=True)
    (folder / "app/index.html").write_text("<!doctype html><title>page</title>")
    (folder / "app/assets/main.js").write_text("export {};")
    subprocess.run([PROGRAM, "sky", "-o", folder / "sky.hdr", "--height", "64", "--no-sun-disc", "--quiet"], check=True)
    corners = [-1, -1, 0, 1, -1, 0, 0, 1, 0]
    (folder / "triangle.bin").write_bytes(struct.pack("<9f", *corners))
    (folder / "tri angle.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "triangle.bin"}]}))
    (folder / "secret.txt").write_text("secret")


@contextlib.contextmanager
def serving(folder, *words):
    """The program, started with these words and stopped as by Ctrl-C; yields its port."""
    command = [PROGRAM, "view", "--no-browser", "--app", "app", *words]
    # A process in the background may have SIGINT ignored; a terminal's has not.
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    try:
        url = process.stdout.readline().strip()
        assert url.startswith("http://127.0.0.1:"), (url, process.stderr.read() if process.poll() is not None else "")
        yield urllib.parse.urlsplit(url).port
    finally:
        process.send_signal(signal.SIGINT)
        try:
            status = process.wait(20)
        finally:
            process.kill()
        said = process.stderr.read()
    assert status == 0, (status, said)


def ask(port, path, method="GET", body=None, headers=()):
    """(status, headers, body) of a request whose path goes out as it is."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request(method, path, body, dict(headers))
    answer = connection.getresponse()
    return answer.status, answer.headers, answer.read()


def truth(port, **changed):
    status, _, body = ask(port, "/api/truth", "POST", json.dumps({**VIEW, **changed}), {"Content-Type": "application/json"})
    assert status == 200, (status, body)
    return body


def ask_for_a_long_picture(port):
    """A connection on which the answer to such a request has begun."""
    connection = socket.create_connection(("127.0.0.1", port))
    body = json.dumps({**VIEW, "width": 1024, "height": 1024, "samples": 65536})
    connection.sendall(f"POST /api/truth HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n{body}".encode())
    assert connection.recv(100)
    return connection


def frames(body):
    """[(width, height, samples, noise, pixels)] of a stream, and the text of the error at its end, or None."""
    found, at = [], 0
    while at < len(body):
        width, height = struct.unpack_from("<2I", body, at)
        if width == 0:
            length = struct.unpack_from("<I", body, at + 8)[0]
            return found, body[at + 16:at + 16 + length].decode()
        samples, noise = struct.unpack_from("<2f", body, at + 8)
        pixels = struct.unpack_from(f"<{3 * width * height}f", body, at + 16)
        found.append((width, height, samples, noise, pixels))
        at += 16 + 12 * width * height
    return found, None


def read_hdr(file):
    """The floats of a Radiance picture with the newer run-length code."""
    head, data = file.read_bytes().split(b"\n\n", 1)
    size, data = data.split(b"\n", 1)
    height, width = int(size.split()[1]), int(size.split()[3])
    pixels, at = [], 0
    for _ in range(height):
        assert data[at:at + 2] == b"\2\2"
        at += 4
        planes = []
        for _ in range(4):
            plane = bytearray()
            while len(plane) < width:
                count = data[at]
                if count > 128:
                    plane += data[at + 1:at + 2] * (count - 128)
                    at += 2
                else:
                    plane += data[at + 1:at + 1 + count]
                    at += 1 + count
            planes.append(plane)
        for r, g, b, e in zip(*planes):
            scale = 2.0 ** (e - 136) if e else 0
            pixels += [(r + 0.5) * scale, (g + 0.5) * scale, (b + 0.5) * scale]
    return pixels


def test_the_page_and_the_files_of_the_command_line_are_served(folder):
    with serving(folder, "tri angle.gltf", "sky.hdr", "--rotate-y-deg", "30") as port:
        status, headers, body = ask(port, "/")
        assert (status, body) == (200, (folder / "app/index.html").read_bytes()) and headers["Content-Type"] == "text/html; charset=utf-8"
        assert "default-src 'self'" in headers["Content-Security-Policy"] and "unsafe-inline" not in headers["Content-Security-Policy"]
        assert headers["X-Content-Type-Options"] == "nosniff" and headers["Cross-Origin-Resource-Policy"] == "same-origin"
        assert ask(port, "/assets/main.js")[0] == 200
        session = json.loads(ask(port, "/api/session")[2])
        assert session["truth"] and session["environment_options"]["rotate_y_deg"] == 30
        assert session["scene"] == {"name": "tri angle.gltf", "url": "/files/scene/tri%20angle.gltf"}
        assert ask(port, session["scene"]["url"])[2] == (folder / "tri angle.gltf").read_bytes()
        assert ask(port, "/files/scene/triangle.bin")[2] == (folder / "triangle.bin").read_bytes()
        sky = session["environment"][0]["url"]
        assert ask(port, sky)[2] == (folder / "sky.hdr").read_bytes()
        status, headers, body = ask(port, sky, headers={"Range": "bytes=2-9"})
        assert (status, body) == (206, (folder / "sky.hdr").read_bytes()[2:10])


def test_a_set_of_probes_is_served_with_the_page(folder):
    subprocess.run([PROGRAM, "probes", "tri angle.gltf", "--env", "sky.hdr", "-o", "probes", "--at", "0,0,1", "--size", "8", "--spp", "1", "--quiet"], cwd=folder, check=True)
    (folder / "probes/notes.txt").write_text("secret")
    with serving(folder, "tri angle.gltf", "sky.hdr", "--probes", "probes") as port:
        files = json.loads(ask(port, "/api/session")[2])["probes"]
        assert [file["name"] for file in files] == ["probes.json", "specular.ktx2", "irradiance.ktx2", "distance.ktx2"], files
        for file in files:
            assert ask(port, file["url"])[2] == (folder / "probes" / file["name"]).read_bytes(), file
        assert ask(port, "/files/probes/notes.txt")[0] == 404
    refused = subprocess.run([PROGRAM, "view", "--no-browser", "--app", "app", "--probes", "app"], cwd=folder, capture_output=True, text=True)
    assert refused.returncode == 1 and "probes.json" in refused.stderr, refused


def test_nothing_else_is_served(folder):
    with serving(folder, "tri angle.gltf", "sky.hdr") as port:
        for path in ["/secret.txt", "/../secret.txt", "/app/../secret.txt", "/%2e%2e/secret.txt", "/files/scene/../secret.txt",
                     "/files/scene/..%2fsecret.txt", "/files/scene/secret.txt", "//etc/passwd", "/files/environment/1/../../secret.txt",
                     "/assets/", "/api", "/files/", f"/{urllib.parse.quote(str(folder / 'secret.txt'), safe='')}"]:
            status, _, body = ask(port, path)
            assert status == 404 and b"secret\n" not in body, (path, status, body)
        for method in ["PUT", "DELETE", "PATCH", "OPTIONS", "POST"]:
            assert ask(port, "/", method)[0] == 405, method


def test_other_hosts_and_origins_are_refused(folder):
    json_type = {"Content-Type": "application/json"}
    with serving(folder, "tri angle.gltf", "sky.hdr") as port:
        own = f"http://127.0.0.1:{port}"
        for headers, wanted in [({}, 200), ({"Host": f"localhost:{port}"}, 200), ({"Origin": own}, 200), ({"Host": "evil.example"}, 403),
                                ({"Host": f"evil.example:{port}"}, 403), ({"Host": "127.0.0.1:1"}, 403), ({"Origin": "http://evil.example"}, 403),
                                ({"Origin": "null"}, 403), ({"Sec-Fetch-Site": "cross-site"}, 403),
                                ({"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate"}, 200)]:
            assert ask(port, "/", headers=headers)[0] == wanted, headers
        body = json.dumps({**VIEW, "samples": 1})
        assert ask(port, "/api/truth", "POST", body, {**json_type, "Origin": "http://evil.example"})[0] == 403
        assert ask(port, "/api/truth", "POST", body, {"Content-Type": "text/plain"})[0] == 415
        assert ask(port, "/api/truth", "POST", " " * 70000 + body, json_type)[0] == 413
        # Only this machine can connect.
        with socket.socket() as other:
            address = next((a[4][0] for a in socket.getaddrinfo(socket.gethostname(), port, socket.AF_INET)), "127.0.0.1")
            assert address.startswith("127.") or other.connect_ex((address, port)) != 0


def test_the_truth_is_the_picture_of_render(folder):
    for turn in [0, 75]:
        with serving(folder, "tri angle.gltf", "sky.hdr") as port:
            found, error = frames(truth(port, rotate_y_deg=turn, occlusion=False))
        assert error is None and found and found[-1][2] == 64
        subprocess.run([PROGRAM, "render", "tri angle.gltf", "--env", "sky.hdr", "--rotate-y-deg", str(turn), "--camera-position", "1.5,1,2",
                        "--camera-target", "0,0,0", "--fov-deg", "40", "--width", "48", "--height", "32", "--spp", "64", "--bounces", "0",
                        "--occlusion", "off", "-o", "picture.hdr", "--quiet"], cwd=folder, check=True)
        subprocess.run([PROGRAM, "info", "picture.hdr"], cwd=folder, check=True, capture_output=True)
        drawn = read_hdr(folder / "picture.hdr")
        assert found[-1][:2] == (48, 32)
        # RGBE has eight bits for the largest channel of a pixel.
        for pixel in range(48 * 32):
            streamed, written = found[-1][4][3 * pixel:3 * pixel + 3], drawn[3 * pixel:3 * pixel + 3]
            assert max(abs(a - b) for a, b in zip(streamed, written)) <= max(streamed) / 120 + 1e-6, (pixel, streamed, written)


def test_a_picture_goes_on_beyond_the_view(folder):
    with serving(folder, "tri angle.gltf", "sky.hdr") as port:
        view = frames(truth(port, samples=512, occlusion=False))[0][-1]
        whole = frames(truth(port, samples=512, occlusion=False, width=64, height=44, view_width=48, view_height=32))[0][-1]
        assert whole[:2] == (64, 44)
        def row(picture, y):
            return picture[4][3 * picture[0] * y:3 * (picture[0] * y + 48)]
        # Two pictures of other random numbers: their noise, which the edges of the triangle have most of.
        differences = [abs(a - b) / (1 + b) for y in range(32) for a, b in zip(row(view, y), row(whole, y))]
        assert max(differences) < 0.1 and sum(differences) / len(differences) < 0.004, (max(differences), sum(differences) / len(differences))
        # What is beyond is more of the scene, and not black.
        assert all(v > 0 for v in whole[4][3 * 64 * 43:])


def test_a_wrong_request_for_a_picture_is_one_sentence(folder):
    with serving(folder, "tri angle.gltf", "sky.hdr") as port:
        for changed, what in [({"width": 0}, "`width`: 0 is not a whole number from 1 to 8192"), ({"samples": 1.5}, "`samples`: 1.5 is not"), ({"view_width": 49}, "`view_width`: 49 is not a whole number from 1 to 48"),
                              ({"target": [0, 0]}, "`target`: is not three numbers"), ({"position": [0, 0, 1e99]}, "`position`"),
                              ({"fov_y_deg": "wide"}, "`fov_y_deg`"), ({"width": 8192, "height": 8192}, "more than 2^23 pixels")]:
            found, error = frames(truth(port, **changed))
            assert not found and what in error, (changed, error)
        status, _, body = ask(port, "/api/truth", "POST", "{", {"Content-Type": "application/json"})
        assert status == 200 and "JSON" in frames(body)[1]


def test_a_new_picture_ends_the_one_before(folder):
    with serving(folder, "tri angle.gltf", "sky.hdr") as port:
        first = ask_for_a_long_picture(port)
        start = time.monotonic()
        found, error = frames(truth(port, samples=4))
        assert error is None and found[-1][2] == 4 and time.monotonic() - start < 30
        rest = b""
        while piece := first.recv(1 << 20):
            rest = (rest + piece)[-4096:]
            if b"cancelled" in rest:
                break
        assert b"cancelled" in rest
        first.close()


def test_ctrl_c_ends_it_while_a_picture_is_rendered(folder):
    with serving(folder, "tri angle.gltf", "sky.hdr") as port:
        other = ask_for_a_long_picture(port)
    other.close()


def test_the_examples_of_the_help_run(folder):
    (folder / "helmet.glb").write_bytes(b"glTF")
    for name in ["studio.hdr", "studio.exr"]:
        (folder / name).write_bytes((folder / "sky.hdr").read_bytes())
    text = subprocess.run([PROGRAM, "view", "--help"], capture_output=True, text=True, check=True).stdout
    examples = [line.split() for line in text.split("\n\n")[0].splitlines()[1:]]
    assert len(examples) >= 2
    for example in examples:
        words = [word for word in example[2:] if word not in ("--port", "8000")]
        with serving(folder, *words) as port:
            assert ask(port, "/")[0] == 200


def test_without_a_scene_there_is_no_truth(folder):
    with serving(folder) as port:
        assert json.loads(ask(port, "/api/session")[2])["truth"] is False
        status, _, body = ask(port, "/api/truth", "POST", json.dumps(VIEW), {"Content-Type": "application/json"})
        assert status == 404 and body == b"There is no scene or no environment on the command line."


def test_wrong_words_are_one_error(folder):
    with serving(folder) as port:
        for words, what, code in [(["--port", str(port)], f"--port: {port} is in use or not allowed", 2), (["--port", "0"], "--port: 0 is not from 1 to 65535", 2),
                                  (["--app", "nowhere"], "--app: there is no index.html", 2), (["none.hdr"], "none.hdr: there is no such file", 1),
                                  (["none.glb"], "none.glb: there is no such file", 1), (["tri angle.gltf", "other.glb"], "other.glb: is a second scene", 1)]:
            app = [] if "--app" in words else ["--app", "app"]
            result = subprocess.run([PROGRAM, "view", "--no-browser", *app, *words], cwd=folder, capture_output=True, text=True, timeout=60)
            errors = [line for line in result.stderr.splitlines() if line.startswith("error:")]
            assert result.returncode == code and len(errors) == 1 and what in errors[0], (words, result.returncode, result.stderr)


if __name__ == "__main__":
    sys.exit(run_folder_tests("view", globals(), sys.argv[1:], prepare))
