"""Runs a campaign on a Ray cluster: each task runs one shard with the `mapless` program.

    python run.py MAPLESS CAMPAIGN.toml OUT [--shards N] [--address HOST:PORT]

Program, campaign and OUT are paths on a file system that every node shares. A shard whose worker dies is given to another
one, which goes on from the shard's journal. Without --address Ray starts a cluster on this machine. Nothing runs twice: what
OUT has of the campaign, from Ray or not, is left out.
"""

import argparse
import pathlib
import subprocess
import sys

import ray


@ray.remote(num_cpus=1, max_retries=5)
def shard(mapless, campaign, out, index, count):
    """One shard, a trial at a time; a task has one processor."""
    command = [mapless, "trials", campaign, "--out", out, "--jobs", "1", "--shard", f"{index}/{count}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    # An error of the program is no fault of the worker: it would come again, so it is told rather than retried.
    return index, done.returncode, done.stdout.strip() if done.returncode == 0 else done.stderr.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mapless", type=pathlib.Path, help="the mapless program")
    parser.add_argument("campaign", type=pathlib.Path, help="the campaign file")
    parser.add_argument("out", type=pathlib.Path, help="folder of the results")
    parser.add_argument("--shards", type=int, help="parts; four for each processor of the cluster when absent")
    parser.add_argument("--address", help="of a running cluster, as ray.init takes it")
    args = parser.parse_args()
    if args.shards is not None and args.shards < 1:
        parser.error(f"--shards {args.shards}: expected 1 or more")

    ray.init(address=args.address, log_to_driver=False, include_dashboard=False, configure_logging=False)
    count = args.shards or 4 * max(1, int(ray.cluster_resources().get("CPU", 1)))
    paths = [str(args.mapless.resolve()), str(args.campaign.resolve()), str(args.out.resolve())]
    waiting = [shard.remote(*paths, index, count) for index in range(1, count + 1)]
    failed = False
    while waiting:
        ready, waiting = ray.wait(waiting)
        for index, code, said in ray.get(ready):
            print(f"shard {index}/{count}: {said}", flush=True)
            failed = failed or code != 0
    if failed:
        return 1
    # Every trial has run: this only writes the final files, with the campaign and the folder as they were named here.
    command = [paths[0], "trials", str(args.campaign), "--out", str(args.out)]
    return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
