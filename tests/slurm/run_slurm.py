#!/usr/bin/env python3
"""`domelight batch slurm` on a real Slurm: slurmctld, two slurmds and munge, started on this machine for the test and ended after it.

Needs root, and Debian's slurm-wlm and munge. DOMELIGHT_PROGRAM names the program; closes with the line that ./test adds up.
"""

import atexit
import contextlib
import hashlib
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from folder_tests import run_folder_tests  # noqa: E402

PROGRAM = os.environ.get("DOMELIGHT_PROGRAM", str(ROOT / "build/dev/cli/domelight"))
MOST_MEMBERS = 7


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class Cluster:
    """A controller and the nodes n1 and n2, of two cores each, on loopback and without systemd."""

    def __init__(self, folder):
        self.folder, self.processes = Path(folder), {}
        host, (controller, first, second) = socket.gethostname().split(".")[0], free_ports(3)
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        (self.folder / "state").mkdir()
        self.conf = self.folder / "slurm.conf"
        self.conf.write_text(f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
AuthType=auth/munge
AuthInfo=socket={self.folder}/munge.socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool-%n
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd-%n.pid
SlurmctldLogFile={self.folder}/slurmctld.log
SlurmdLogFile={self.folder}/slurmd-%n.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=batch_sched_delay=0,sched_interval=2,sched_min_interval=0
SlurmdTimeout=6
KillWait=2
MaxArraySize={MOST_MEMBERS + 1}
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={first} CPUs=2 RealMemory=3000 State=UNKNOWN
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={second} CPUs=2 RealMemory=3000 State=UNKNOWN
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
""")
        self.environment = {**os.environ, "SLURM_CONF": str(self.conf)}
        self.start("munged", ["munged", "--force", "--foreground", f"--key-file={key}", f"--socket={self.folder}/munge.socket", f"--pid-file={self.folder}/munged.pid",
                              f"--log-file={self.folder}/munged.log", f"--seed-file={self.folder}/munged.seed"])
        self.wait_for(lambda: (self.folder / "munge.socket").exists(), 20)
        self.start("slurmctld", ["slurmctld", "-D", "-f", self.conf])
        for node in ["n1", "n2"]:
            self.start(node, ["slurmd", "-D", "-N", node, "-f", self.conf])
        self.wait_for(lambda: self.call("sinfo", "-h", "-N", "-o", "%N %t").split() == ["n1", "idle", "n2", "idle"], 60)

    def start(self, name, command):
        log = open(self.folder / f"{name}.out", "w")
        self.processes[name] = subprocess.Popen(command, stdout=log, stderr=log, env=self.environment)

    def call(self, *words):
        return subprocess.run(words, capture_output=True, text=True, env=self.environment).stdout

    def wait_for(self, test, seconds):
        end = time.monotonic() + seconds
        while not test():
            assert time.monotonic() < end, f"{self.call('squeue')}{self.call('sinfo')}{(self.folder / 'slurmctld.log').read_text()[-3000:]}"
            time.sleep(0.2)

    def drain(self, seconds=180):
        self.wait_for(lambda: not self.call("squeue", "-h"), seconds)

    def lose_node(self, node):
        """Ends the node's daemon, the processes that watch over its jobs, and the jobs, all without warning."""
        self.processes[node].kill()
        jobs = []
        for place in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                words = (place / "environ").read_bytes().split(b"\0")
                if f"SLURMD_NODENAME={node}".encode() in words and f"SLURM_CONF={self.conf}".encode() in words:
                    parent = int((place / "stat").read_text().rsplit(")", 1)[1].split()[1])
                    watcher = Path(f"/proc/{parent}/cmdline").read_bytes().startswith(b"slurmstepd")
                    jobs += [parent] * watcher + [int(place.name)]
        for process in jobs:
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        return len(jobs)

    def stop(self):
        for name in reversed(list(self.processes)):
            self.processes[name].send_signal(signal.SIGKILL if name == "munged" else signal.SIGTERM)
        for process in self.processes.values():
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(10)
            process.kill()


cluster = None


def run(*words, folder, code=0):
    result = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=300, env=cluster.environment)
    assert result.returncode == code, f"{words}: exit {result.returncode}, not {code}\n{result.stdout}{result.stderr}"
    return result


def results_of(batch):
    return {str(p.relative_to(batch)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(batch.rglob("results/*/*/**/*")) if p.is_file()}


def set_of(batch):
    """The bytes of the set: results, index and the names of the outputs."""
    return results_of(batch), (batch / "index.jsonl").read_text(), sorted(str(p.relative_to(batch)) for p in batch.glob("out/**/*"))


def whole_set(folder, size):
    """A plan, and the set that one run on this machine makes of it."""
    run("batch", "plan", "hdris", "-o", "batch", "--set", f"size={size}", folder=folder)
    run("batch", "run", "batch", folder=folder)
    whole = set_of(folder / "batch")
    for name in ["results", "out", "log"]:
        shutil.rmtree(folder / "batch" / name)
    (folder / "batch/index.jsonl").unlink()
    return whole


def submit(folder, *words):
    return json.loads(run("batch", "slurm", "batch", "--json", *words, folder=folder).stdout)


def test_an_array_of_shards_makes_the_same_set(folder):
    whole, batch = whole_set(folder, 64), folder / "batch"
    told = submit(folder, "--shards", "7")
    assert told["shards"] == 7 and told["members"] == "1-7" and told["jobs_left"] == 12 and told["minutes"] > 10 and told["megabytes"] > 256
    assert "still waits or runs" in run("batch", "slurm", "batch", folder=folder, code=1).stderr
    cluster.drain()
    assert set_of(batch) == whole and (batch / "report/index.html").exists()
    assert not list(batch.glob("work/*"))
    assert "every job has its result" in run("batch", "slurm", "batch", folder=folder).stdout
    # Only the shard of what is missing is submitted again.
    shutil.rmtree(next(batch.glob("results/*/*")))
    told = submit(folder)
    assert told["shards"] == 7 and told["jobs_left"] == 1 and told["members"].isdigit(), told
    cluster.drain()
    assert set_of(batch) == whole


def test_an_array_is_no_larger_than_the_cluster_takes(folder):
    run("batch", "plan", "hdris", "-o", "batch", "--set", "size=16", folder=folder)
    result = run("batch", "slurm", "batch", "--shards", "100", folder=folder)
    assert f"takes arrays of {MOST_MEMBERS} members" in result.stderr and f"1-{MOST_MEMBERS} of {MOST_MEMBERS}" in result.stdout
    cluster.drain()
    assert "all intact" in run("batch", "verify", "batch", folder=folder).stdout


def test_a_lost_node_changes_nothing(folder):
    whole, batch = whole_set(folder, 512), folder / "batch"
    submit(folder, "--shards", "4")
    # In the middle: something is done, and a shard runs on the node that goes.
    cluster.wait_for(lambda: len(list(batch.glob("results/*/*/done.json"))) >= 2, 60)
    assert "n2" in cluster.call("squeue", "-h", "-t", "R", "-o", "%N"), cluster.call("squeue")
    assert cluster.lose_node("n2") > 0
    done = len(list(batch.glob("results/*/*/done.json")))
    assert 0 < done < 12, done
    cluster.drain()
    assert "down" in cluster.call("sinfo", "-h", "-N", "-n", "n2", "-o", "%t")
    assert set_of(batch) == whole, (batch / "slurm/merge.log").read_text()
    assert not list(batch.glob("work/*"))
    assert "all intact" in run("batch", "verify", "batch", folder=folder).stdout


def prepare(folder):
    (folder / "hdris").mkdir()
    for index in range(12):
        run("sky", "-o", f"hdris/sky{index}.hdr", "--height", "128", "--sun-elevation-deg", 5 * index + 1, folder=folder)


if __name__ == "__main__":
    programs = ["slurmctld", "slurmd", "munged", "sbatch"]
    os.environ["PATH"] += ":/usr/sbin"
    lacking = [program for program in programs if not shutil.which(program)]
    if lacking or os.geteuid() != 0:
        print(f"skipped: Slurm: {'needs root' if not lacking else 'no ' + ', '.join(lacking)}\nslurm: 0 passed, 0 failed, 1 skipped")
        sys.exit(0)
    place = tempfile.mkdtemp(prefix="domelight-slurm-")
    cluster = Cluster(place)
    atexit.register(lambda: (cluster.stop(), shutil.rmtree(place, ignore_errors=True)))
    sys.exit(run_folder_tests("slurm", dict(globals()), sys.argv[1:], prepare))
