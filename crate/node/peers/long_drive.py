"""A long drive of `mapless-node` beside a robot: every cloud must be answered once, while other peers come and go.

    long_drive.py PROGRAM CONFIG PEER SECONDS [WRAPPER ...]

PEER is `rclpy` or `cyclone`; the node is begun by the words of WRAPPER, such as `ip netns exec NAME`.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import checks

os.environ["ROS_DOMAIN_ID"] = str(checks.DOMAIN)

from robot import NAMESPACE, Robot, until  # noqa: E402

# From the arrival of a scan to its command, at 99 %.
LIMIT_MS = 30.0
# A peer comes this often, and stays for five seconds.
VISITS_EVERY_S = 20.0
# A robot that says nothing for so long is stopped, as an IMU must not be older than 0.1 s; it goes on within this time.
SILENCE_S = 0.08
PAUSE_S = 2.0


def wire_of(peer):
    if peer == "cyclone":
        from wire_cyclone import Wire

        return Wire(NAMESPACE, checks.DOMAIN)
    from wire_rclpy import Wire

    return Wire(NAMESPACE)


def visit(peer, domain):
    """A peer that hears the commands for a while; its exit code tells whether it heard any."""
    checks.DOMAIN = int(domain)
    os.environ["ROS_DOMAIN_ID"] = domain
    wire, heard = wire_of(peer), []
    wire.subscribe(wire.messages.TwistStamped, "cmd_vel", heard.append)
    wire.spin()
    time.sleep(5.0)
    # A middleware's threads abort an orderly end now and then.
    os._exit(not heard)


class Process:
    """What the system knows of a process."""

    def __init__(self, process):
        self.folder = Path(f"/proc/{process.pid}")

    def cpu_s(self):
        fields = (self.folder / "stat").read_text(encoding="ascii").rsplit(") ", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory_mb(self):
        lines = (self.folder / "status").read_text(encoding="ascii").splitlines()
        return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS")) / 1024.0


def drive(robot, node, peer, seconds, is_reliable):
    """Drives, and says what became of the clouds; whether all is well."""
    robot.is_scanning = False
    time.sleep(0.5)
    if is_reliable:
        robot.wire.remove_publisher(robot.scan)
        robot.scan = robot.scan_publisher(is_reliable=True)
    robot.is_scanning = True
    if not checks.drive(robot):
        return False, f"it does not drive: {checks.state(robot)}"
    time.sleep(2.0)
    process, visitors = Process(node.process), []
    begin, cpu_s, memory_mb = time.monotonic(), process.cpu_s(), process.memory_mb()
    while time.monotonic() < begin + seconds:
        if time.monotonic() > begin + VISITS_EVERY_S * len(visitors):
            visitors.append(subprocess.Popen([sys.executable, __file__, "visit", peer, str(checks.DOMAIN)]))
        time.sleep(0.2)
    end, load = time.monotonic(), os.getloadavg()[0]
    cpu_s, memory_mb = process.cpu_s() - cpu_s, (memory_mb, process.memory_mb())
    deaf = sum(visitor.wait(20) != 0 for visitor in visitors)
    time.sleep(1.0)

    sent, once, never, delays_s = checks.answers_to_clouds(robot, begin, end)
    slowest = sorted(took for at, took in list(robot.slowest_ms) if begin + 1.5 <= at < end)
    commands = [command for command in list(robot.commands) if begin <= command[0] < end]
    gap_s = max(later[0] - earlier[0] for earlier, later in zip(commands, commands[1:]))
    ticks = [at for at in list(robot.ticks) if begin - PAUSE_S <= at <= end]
    silences = [(earlier, later) for earlier, later in zip(ticks, ticks[1:]) if later - earlier > SILENCE_S]
    is_excused = lambda at: any(earlier <= at <= later + PAUSE_S for earlier, later in silences)
    stopped = [at for at, v, _ in commands if v == 0.0]
    standing = sum(not is_excused(at) for at in stopped)
    share = lambda values, part: values[min(int(part * len(values)), len(values) - 1)]
    sending = [1e3 * share(delays_s, part) for part in (0.5, 0.99, 1.0)]
    # Of about ten scans each, the slowest is beyond 30 ms for one in ten, where one in a hundred scans is.
    answering = [share(slowest, part) for part in (0.5, 0.9, 1.0)]
    ok = sent > 9.5 * seconds and once == sent and answering[1] <= LIMIT_MS and not standing and not deaf
    return ok, (
        f"{once} of {sent} clouds answered by one decision, {never} by none; "
        f"from sending a cloud to its decision here {sending[0]:.1f} ms in the median, {sending[1]:.1f} at 99 %, {sending[2]:.1f} at most; "
        f"from its arrival to its command {answering[0]:.1f} ms as the slowest of a second in the median, {answering[1]:.1f} at 90 %, "
        f"{answering[2]:.1f} at most; "
        f"{len(commands) / (end - begin):.1f} commands a second, the longest gap {1e3 * gap_s:.0f} ms, {len(stopped)} of them zero, "
        f"{standing} without a silence of the robot's ({len(silences)} of more than {1e3 * SILENCE_S:.0f} ms); "
        f"{len(visitors)} peers came and went, {deaf} heard nothing; "
        f"{100.0 * cpu_s / (end - begin):.1f} % of a core, {memory_mb[0]:.0f} to {memory_mb[1]:.0f} MB; load {load:.1f}"
    )


def main():
    program, config, peer, seconds, *wrapper = sys.argv[1:]
    robot = Robot(wire_of(peer))
    robot.start()
    failed = passed = 0
    with tempfile.TemporaryDirectory() as folder:
        node = checks.Node([*wrapper, program], config, folder)
        try:
            for is_reliable in (False, True):
                ok, found = drive(robot, node, peer, float(seconds) / 2.0, is_reliable)
                passed, failed = passed + ok, failed + (not ok)
                kind = "reliable" if is_reliable else "best effort"
                print(f"{'ok' if ok else 'FAILED'}: {kind}: {found}", flush=True)
        finally:
            node.kill()
    print(f"{failed} failed\n{passed} passed", flush=True)
    # Threads of a middleware abort an orderly end now and then.
    os._exit(failed > 0)


if __name__ == "__main__":
    visit(*sys.argv[2:]) if sys.argv[1] == "visit" else main()
