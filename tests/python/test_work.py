"""Progress, cancelling, Ctrl-C, threads and forks."""

import multiprocessing
import os
import pathlib
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import domelight as dl


def test_progress_is_told(light):
    told = []
    dl.prefilter(light, size=32, levels=4, progress=lambda stage, done: told.append((stage, done)))
    assert told and told[-1] == ("filter", 1) and all(0 <= done <= 1 for _, done in told)
    assert threading.current_thread() is threading.main_thread()


def test_progress_is_told_on_the_calling_thread(light):
    threads = set()
    dl.prefilter(light, size=32, levels=4, progress=lambda *_: threads.add(threading.get_ident()))
    assert threads == {threading.get_ident()}


def test_a_callback_cancels(light):
    with pytest.raises(dl.Cancelled):
        dl.prefilter(light, size=512, levels=6, progress=lambda *_: False)


def test_what_a_callback_raises_arrives(light):
    def fail(stage, done):
        raise KeyError("from the callback")

    with pytest.raises(KeyError, match="from the callback"):
        dl.prefilter(light, size=512, levels=6, progress=fail)


def test_tqdm(light, tmp_path):
    tqdm = pytest.importorskip("tqdm")
    with open(tmp_path / "bar.txt", "w+") as text:
        with tqdm.tqdm(total=100, file=text) as bar:
            dl.bake(light, tmp_path / "out", size=32, progress=bar)
            assert bar.n > 0
        text.seek(0)
        assert "%" in text.read()


@pytest.mark.parametrize("with_tqdm", [True, False])
def test_a_bar_of_its_own_is_full_and_closed(light, tmp_path, capfd, monkeypatch, with_tqdm):
    if with_tqdm:
        pytest.importorskip("tqdm")
    else:
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)  # importing it raises ImportError
    dl.bake(light, tmp_path / "out", size=32, progress=True)
    shown = capfd.readouterr().err
    assert shown.endswith("\n") and "100" in shown.rsplit("\r", 1)[-1]
    with pytest.raises(dl.Error):
        dl.bake(light, tmp_path / "out", size=-1, progress=True)
    assert capfd.readouterr().err.endswith("\n")


def test_another_thread_runs_meanwhile():
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    other = threading.Thread(target=count)
    other.start()
    sky = dl.sky(256)
    before = counted[0]
    dl.prefilter(sky, size=512, levels=6)
    stop.set()
    other.join()
    assert counted[0] - before >= 3


def test_several_threads_at_once(light):
    expected = dl.prefilter(light, size=32, levels=3)
    results = [None] * 4

    def work(i):
        results[i] = dl.prefilter(light, size=32, levels=3)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all(a.tobytes() == b.tobytes() for result in results for a, b in zip(result, expected))


def test_a_callback_calls_the_library(light):
    told = []
    dl.prefilter(light, size=32, levels=3, progress=lambda *_: told.append(dl.irradiance(light, size=1).shape))
    assert told and set(told) == {(6, 1, 1, 3)}


INTERRUPTED = textwrap.dedent("""
    import signal, sys
    signal.signal(signal.SIGINT, signal.default_int_handler)
    import domelight as dl
    sky = dl.sky(1024)
    print("ready", flush=True)
    try:
        while True:
            dl.prefilter(sky, size=2048, levels=8)
    except KeyboardInterrupt:
        print("interrupted", flush=True)
        dl.irradiance(sky, size=4)  # it still works
        print("done", flush=True)
""")


def test_ctrl_c_cancels():
    child = subprocess.Popen([sys.executable, "-c", INTERRUPTED], stdout=subprocess.PIPE, text=True,
                             preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    assert child.stdout.readline() == "ready\n"
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    begin = time.monotonic()
    assert child.stdout.readline() == "interrupted\n"
    assert time.monotonic() - begin < 10
    assert child.communicate(timeout=60)[0] == "done\n" and child.returncode == 0


def filtered_in_child(queue, image):
    queue.put(float(dl.prefilter(image, size=16, levels=2)[1].sum()))


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
def test_a_forked_child_works(light):
    expected = float(dl.prefilter(light, size=16, levels=2)[1].sum())
    dl.Sampler(light).sample(100_000)
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=filtered_in_child, args=(queue, light))
    child.start()
    assert queue.get(timeout=60) == expected
    child.join(timeout=60)
    assert child.exitcode == 0


def resident_bytes():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not pathlib.Path("/proc/self/statm").exists(), reason="no /proc")
def test_ten_thousand_calls_need_no_memory():
    light = np.ones((8, 16, 3), np.float32)
    sampler, points = dl.Sampler(light), dl.unit_points(64)

    def calls(count):
        for i in range(count):
            dl.spherical_harmonics(light, 2)
            sampler.sample(points)
            sampler.pdf([[0, 1, 0]])
            dl.Environment(light).radiance([[1, 0, 0]])
            try:
                dl.prefilter(light, size=0)
            except dl.Error:
                pass

    calls(200)
    before = resident_bytes()
    calls(2000)
    assert resident_bytes() - before < 4 << 20


INTERRUPTED_BAKE = textwrap.dedent("""
    import pathlib, signal, sys
    signal.signal(signal.SIGINT, signal.default_int_handler)
    import domelight as dl
    sky, folder = dl.sky(512), pathlib.Path(sys.argv[1])
    dl.bake(sky, folder, size=64)
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    print("ready", flush=True)
    try:
        dl.bake(sky, folder, size=4096, encoding="bc6h", encoding_quality="high")
    except KeyboardInterrupt:
        print("same" if {file.name: file.read_bytes() for file in folder.iterdir()} == before else "changed")
""")


def test_ctrl_c_in_a_bake_changes_nothing(tmp_path):
    child = subprocess.Popen([sys.executable, "-c", INTERRUPTED_BAKE, str(tmp_path / "out")], stdout=subprocess.PIPE, text=True,
                             preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    assert child.stdout.readline() == "ready\n"
    time.sleep(0.5)
    child.send_signal(signal.SIGINT)
    assert child.communicate(timeout=120)[0] == "same\n" and child.returncode == 0
