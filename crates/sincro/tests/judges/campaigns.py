"""Judges campaigns: 10,000 runs in 1, 2 and 7 shards whose processes are killed at random times and started again.

usage: campaigns.py SINCRO WORK [RUNS]

Bounds: `runs.parquet` of all shardings has the same bytes; drawn runs, made again alone, have the trace of their row;
a campaign makes at least five times as many runs of the closed-loop quadrotor as `sincro run` in a shell loop on all
processors. HyperQueue (its Python package) and Slurm (its daemons, as root) take part where they are installed, DuckDB and
Polars where Python has them; what is skipped is said.
"""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[4]

ALEXANDROS = """
title = "Compliant arm with springs that differ"
scene = "{scene}"
seed = 5
runs = {runs}
[set]
duration = 2.0
[[parameter]]
name = "K1"
path = "/motor1/spring1.spring.stiffness"
unit = "N·m/rad"
normal = {{ mean = 2.93, std = 0.3, min = 1.0 }}
[[parameter]]
name = "K4"
path = "/motor1/spring1/motor2/spring2/motor3/spring3/motor4/spring4.spring.stiffness"
unit = "N·m/rad"
uniform = {{ from = 1.0, to = 2.0 }}
[[parameter]]
name = "lambda"
path = "parameters.lambda"
unit = "1/s"
log_uniform = {{ from = 0.2, to = 2.0 }}
[[measure]]
name = "miss"
signal = "miss"
unit = "m"
at_most = 0.02
"""

QUADROTOR = """
scene = "{scene}"
seed = 1
runs = 100
[[parameter]]
name = "lag"
path = "parameters.tau"
unit = "s"
uniform = {{ from = 0.1, to = 0.17 }}
[[measure]]
name = "height"
signal = "/air/quadrotor.position.z"
unit = "m"
"""

failures = []


def bound(holds, words):
    print(("ok    " if holds else "FAIL  ") + words, flush=True)
    if not holds:
        failures.append(words)


def skip(words):
    print("skip  " + words, flush=True)


def call(*arguments):
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, arguments))}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def killed_until_done(sincro, plan, out, shards, rng, longest):
    """All shards, each killed after random times until it comes to its end; the number of kills."""
    n_kills, left = 0, list(range(1, shards + 1))
    while left:
        index = rng.choice(left)
        command = [sincro, "sweep", plan, "--out", out, "--shard", f"{index}/{shards}", "--quiet"]
        process = subprocess.Popen([str(c) for c in command])
        try:
            if process.wait(timeout=rng.uniform(0.1, longest)) != 0:
                raise SystemExit(f"shard {index}/{shards}: {process.returncode}")
            left.remove(index)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            process.wait()
            n_kills += 1
    return n_kills


def shards(sincro, work, n_runs):
    rng = random.Random(7)
    plan = work / "alexandros.toml"
    plan.write_text(ALEXANDROS.format(scene=ROOT / "scenes/alexandros-position", runs=n_runs))
    whole = work / "whole"
    clock = time.monotonic()
    call(sincro, "sweep", plan, "--out", whole, "--replays", "0")
    print(f"      {n_runs} runs of 2 s in {time.monotonic() - clock:.1f} s", flush=True)
    table = (whole / "runs.parquet").read_bytes()
    for count in (1, 2, 7):
        out = work / f"shards-{count}"
        n_kills = killed_until_done(sincro, plan, out, count, rng, max(1.0, 9e-4 * n_runs))
        call(sincro, "sweep", "collect", out, "--replays", "0")
        same = (out / "runs.parquet").read_bytes() == table
        bound(same, f"{count} shards, killed {n_kills} times: the same bytes")
    for k in rng.sample(range(n_runs), 3):
        call(sincro, "sweep", plan, "--out", whole, "--only", k, "--quiet")
        trace = json.loads((whole / f"runs/{k}/run.json").read_text())["trace_hash"]
        bound(trace.encode() in table, f"run {k} again: trace {trace} is in the table")
    return whole


def readers(whole, n_runs):
    query = whole / "runs.parquet"
    try:
        import duckdb

        n, least, most = duckdb.sql(f"select count(distinct k), min(k), max(k) from '{query}'").fetchall()[0]
        bound((n, least, most) == (n_runs, 0, n_runs - 1), "DuckDB reads every run once")
    except ImportError:
        skip("DuckDB is not installed")
    try:
        import polars

        frame = polars.read_parquet(query)
        bound(frame.height == n_runs and frame["k"].n_unique() == n_runs, "Polars reads every run once")
    except ImportError:
        skip("Polars is not installed")


def throughput(sincro, work):
    scene = ROOT / "scenes/quadrotor-flight-1"
    plan = work / "quadrotor.toml"
    plan.write_text(QUADROTOR.format(scene=scene))
    clock = time.monotonic()
    call(sincro, "sweep", plan, "--out", work / "quadrotor", "--replays", "0")
    of_campaign = 100 / (time.monotonic() - clock)
    n, n_processors = 40, os.cpu_count()
    out = work / "loop"
    out.mkdir()
    each = f"{sincro} run {scene} --only main --quiet --set parameters.tau=0.1{{}} --out {out}/{{}}"
    clock = time.monotonic()
    loop = f"seq 10 {10 + n - 1} | xargs -P {n_processors} -I{{}} sh -c '{each} || [ $? = 1 ]'"
    subprocess.run(["sh", "-c", loop], check=True)
    of_loop = n / (time.monotonic() - clock)
    words = f"closed-loop quadrotor: {of_campaign:.1f} runs a second, a shell loop {of_loop:.2f}: {of_campaign / of_loop:.1f} times"
    bound(of_campaign >= 5 * of_loop, words)


SLURM = """ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
AuthType=auth/munge
AuthInfo=socket={work}/munge.socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
ReturnToService=2
SlurmUser=root
SlurmdUser=root
SlurmctldPidFile={work}/slurmctld.pid
SlurmdPidFile={work}/slurmd.pid
SlurmdSpoolDir={work}/slurmd
StateSaveLocation={work}/slurmctld
SlurmctldLogFile={work}/slurmctld.log
SlurmdLogFile={work}/slurmd.log
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def slurm(sincro, work, plan, table):
    """An array of Slurm on one node, all of it on loopback and in the folder of the judge."""
    if any(shutil.which(name) is None for name in ("slurmctld", "slurmd", "munged", "sbatch")) or os.geteuid() != 0:
        skip("slurm: slurmctld, slurmd, munge and sbatch are not installed, or this is not root")
        return
    node = work / "slurm-node"
    for name in ("slurmd", "slurmctld"):
        (node / name).mkdir(parents=True)
    os.chmod(node, 0o755)
    host = os.uname().nodename.split(".")[0]
    (node / "slurm.conf").write_text(SLURM.format(host=host, work=node, cpus=os.cpu_count()))
    key = node / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o400)
    os.environ["SLURM_CONF"] = str(node / "slurm.conf")
    munge = [f"--{name}={node}/munge.{ending}" for name, ending in
             (("key-file", "key"), ("socket", "socket"), ("pid-file", "pid"), ("log-file", "log"), ("seed-file", "seed"))]
    started = [
        subprocess.Popen(["munged", "--force", "--foreground", *munge], stderr=subprocess.DEVNULL),
    ]
    time.sleep(1)
    started += [subprocess.Popen([name, "-D"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for name in ("slurmctld", "slurmd")]
    try:
        for _ in range(60):
            state = subprocess.run(["sinfo", "-h", "-o", "%t"], capture_output=True, text=True).stdout.strip()
            if state == "idle":
                break
            time.sleep(0.5)
        else:
            skip(f"slurm: the node does not come up ({state or 'no answer'})")
            return
        out, clock = work / "slurm", time.monotonic()
        call(sincro, "sweep", "submit", plan, "--out", out, "--on", "slurm", "--shards", "4")
        while subprocess.run(["squeue", "-h"], capture_output=True, text=True).stdout.strip():
            time.sleep(0.5)
        seconds = time.monotonic() - clock
        call(sincro, "sweep", "collect", out, "--replays", "0")
        bound((out / "runs.parquet").read_bytes() == table, f"slurm, 4 shards in {seconds:.1f} s: the same bytes")
    finally:
        for process in reversed(started):
            process.terminate()
            process.wait()


def hyperqueue(sincro, work, plan, table):
    """Shards as tasks of a server and a worker of HyperQueue on loopback, from its Python package."""
    try:
        from hyperqueue import Job, LocalCluster
        from hyperqueue.client import FailedJobsException
        from hyperqueue.cluster import WorkerConfig
    except ImportError:
        skip("hyperqueue: the Python package is not installed")
        return
    out, n = work / "hyperqueue", 8
    with LocalCluster() as cluster:
        cluster.start_worker(WorkerConfig(cores=os.cpu_count()))
        job = Job(default_workdir=work)
        for index in range(1, n + 1):
            arguments = [sincro, "sweep", plan, "--out", out, "--shard", f"{index}/{n}", "--threads", 1, "--quiet"]
            job.program([str(a) for a in arguments])
        client = cluster.client()
        clock = time.monotonic()
        try:
            client.wait_for_jobs([client.submit(job)])
        except FailedJobsException as failed:
            raise SystemExit("\n".join([str(failed), *(path.read_text() for path in work.glob("*.stderr"))])) from failed
        seconds = time.monotonic() - clock
    call(sincro, "sweep", "collect", out, "--replays", "0")
    bound((out / "runs.parquet").read_bytes() == table, f"hyperqueue, {n} shards in {seconds:.1f} s: the same bytes")


def engines(sincro, work):
    plan = work / "alexandros.toml"
    table = (work / "whole/runs.parquet").read_bytes()
    slurm(sincro, work, plan, table)
    hyperqueue(sincro, work, plan, table)
    out = work / "local"
    call(sincro, "sweep", "submit", plan, "--out", out, "--on", "local", "--shards", "2")
    call(sincro, "sweep", "collect", out, "--replays", "0")
    bound((out / "runs.parquet").read_bytes() == table, "submit --on local: the same bytes")
    out = work / "hq"
    said = call(sincro, "sweep", "submit", plan, "--out", out, "--on", "hq", "--shards", "3", "--dry-run")
    bound(f"--array 1-3 --stdout {out}/jobs/hq-" in said, "submit --on hq: what shards say goes into the campaign's folder")


def main():
    sincro, work = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    n_runs = int(sys.argv[3]) if len(sys.argv) > 3 else 10_000
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    work = work.resolve()
    whole = shards(sincro, work, n_runs)
    readers(whole, n_runs)
    engines(sincro, work)
    throughput(sincro, work)
    sys.exit(1 if failures else 0)


main()
