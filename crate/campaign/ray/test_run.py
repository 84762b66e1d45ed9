"""run.py on a local cluster of two nodes; the worker of one is killed midway with the program that it runs: the same bytes as without Ray.

    python test_run.py MAPLESS
"""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from ray.cluster_utils import Cluster

HERE = pathlib.Path(__file__).parent
MAPLESS = pathlib.Path(sys.argv.pop()).resolve()
RECIPE = """name = "Meadow"
size_m = [16.0, 10.0]
cell_m = 0.2
seed = 5

[[noise]]
amplitude_m = 0.2
wavelength_m = 6.0
octaves = 2
"""
SCENARIO = """terrain = "meadow.toml"
start = [4.0, 5.0, 0.3]
goal = [11.0, 5.0]
seed = 1

[sensor]
columns = 450

[planner.perception]
surface_radius_m = 4.0
"""
CAMPAIGN = """planners = ["default", "paper"]
routes = ["east.toml"]
seeds = { from = 1, to = 10 }
trajectories = true
"""
SHARDS = 4


def results(folder):
    """The bytes of all that must be the same, by name."""
    names = ["trials.csv", "trials.parquet", "campaign.json"]
    files = [folder / name for name in names] + sorted((folder / "trajectories").iterdir())
    return {file.name: file.read_bytes() for file in files}


def journalled(folder):
    """Trials in the journals of a folder."""
    return sum(max(0, len(file.read_text().splitlines()) - 1) for file in folder.glob("journal*.jsonl"))


def processes():
    """Title and parent of every process, by its id."""
    found = {}
    for folder in pathlib.Path("/proc").iterdir():
        if not folder.name.isdigit():
            continue
        try:
            title = (folder / "cmdline").read_bytes()
            parent = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1])
        except (OSError, ValueError):
            continue
        found[int(folder.name)] = (title, parent)
    return found


def task_workers():
    """Process ids of the workers that run a shard, with that of the node each belongs to."""
    return [(process, parent) for process, (title, parent) in processes().items() if title.startswith(b"ray::shard")]


def programs_of(worker):
    """Process ids of the programs that a worker runs: they would go on without it."""
    return [process for process, (_, parent) in processes().items() if parent == worker]


class Run(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        root = self.root = pathlib.Path(self.folder.name)
        for name, text in [("meadow.toml", RECIPE), ("east.toml", SCENARIO), ("small.toml", CAMPAIGN)]:
            (root / name).write_text(text)

    def mapless(self, out):
        subprocess.run([MAPLESS, "trials", "small.toml", "--out", out], cwd=self.root, check=True)

    def test_a_killed_worker_changes_nothing(self):
        cluster = Cluster()
        self.addCleanup(cluster.shutdown)
        for _ in range(2):
            cluster.add_node(num_cpus=1, include_dashboard=False)
        command = [sys.executable, HERE / "run.py", MAPLESS, "small.toml", "ray"]
        command += ["--shards", str(SHARDS), "--address", cluster.address]
        driver = subprocess.Popen(command, cwd=self.root, stdout=subprocess.PIPE, text=True)
        self.addCleanup(driver.kill)

        end = time.monotonic() + 60
        while journalled(self.root / "ray") < 2 or len(task_workers()) < 2:
            self.assertIsNone(driver.poll(), "the driver ended before a worker could be killed")
            self.assertLess(time.monotonic(), end, "no worker began")
            time.sleep(0.01)
        workers = task_workers()
        nodes = {parent for _, parent in workers}
        self.assertEqual(len(nodes), 2, "both nodes work")
        worker = workers[0][0]
        programs = programs_of(worker)
        self.assertEqual(len(programs), 1, "the worker runs its shard")
        for process in [worker, *programs]:
            os.kill(process, signal.SIGKILL)
        before = journalled(self.root / "ray")
        said, _ = driver.communicate(timeout=90)
        self.assertEqual(driver.returncode, 0, said)
        self.assertLess(before, 20, "the worker was killed before the end")
        self.assertEqual(sum(line.startswith("shard ") for line in said.splitlines()), SHARDS, said)

        self.mapless("alone")
        self.assertEqual(results(self.root / "ray"), results(self.root / "alone"))
        self.assertEqual(journalled(self.root / "ray"), 20, "a trial was lost or ran twice")

    def test_an_error_of_the_program_is_told(self):
        (self.root / "small.toml").write_text("planners = []\n")
        command = [sys.executable, HERE / "run.py", MAPLESS, "small.toml", "ray", "--shards", "1"]
        done = subprocess.run(command, cwd=self.root, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1, done)
        self.assertIn("shard 1/1: error: ", done.stdout)
        self.assertIn("small.toml", done.stdout)


if __name__ == "__main__":
    result = unittest.main(exit=False, verbosity=2).result
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed - len(result.skipped)} passed\n{failed} failed")
    sys.exit(not result.wasSuccessful())
