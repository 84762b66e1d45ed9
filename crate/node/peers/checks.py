"""What is checked of `mapless-node` with a robot, whatever DDS that speaks."""

import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from robot import Robot, until

# Both processes alone in a domain of their own.
DOMAIN = 64 + os.getpid() % 64
# Discovery under load takes up to 13 s.
DISCOVERY_S = 30.0
FAR_M = 500.0
# A command every 20 ms, sent on by a loaded machine.
SLACK_S = 0.15


class Node:
    """The node under test, begun by the words of `command`, with a copy of the configuration in `folder`."""

    def __init__(self, command, config, folder):
        self.command, self.config = command, Path(folder) / "robot.yaml"
        self.config.write_text(Path(config).read_text(encoding="utf-8"), encoding="utf-8")
        self.configure("domain_id: 0", f"domain_id: {DOMAIN}")
        self.start()

    def configure(self, line, instead):
        text = self.config.read_text(encoding="utf-8")
        assert line in text, f"{self.config}: expected {line!r}"
        self.config.write_text(text.replace(line, instead), encoding="utf-8")

    def start(self):
        self.process = subprocess.Popen([*self.command, self.config])

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(10)

    def kill(self):
        self.process.kill()
        self.process.wait()


def state(robot):
    """The state and reason that the diagnostics tell."""
    return robot.diagnosis.message if robot.diagnosis else ""


def drive(robot):
    """Has the robot drive towards a far goal; the goal is given until it is taken."""

    def drives():
        if not robot.is_driving():
            robot.send_goal(robot.x + FAR_M, robot.y)
            time.sleep(1.0)
        return robot.is_driving()

    return until(drives, DISCOVERY_S)


def stops(robot, fault, limit_s, reason):
    """Whether zero comes within the limit after a fault, and the diagnostics name the reason."""
    if not drive(robot):
        return False, f"it does not drive: {state(robot)}"
    began = time.monotonic()
    fault()
    # Those after the fault.
    first = lambda: next((at for at, v, w in robot.commands if at > began and v == 0.0 and w == 0.0), None)
    until(lambda: first() is not None, limit_s + 2.0)
    if first() is None:
        return False, f"no zero command within {limit_s + 2.0:.2f} s; expected {reason}"
    took = first() - began
    told = until(lambda: reason in state(robot), 3.0)
    after = [v for at, v, w in robot.commands if at >= first() and (v != 0.0 or w != 0.0)]
    ok = took < limit_s + SLACK_S and told and not after
    return ok, f"stopped after {took:.3f} s of {limit_s:.2f}: {state(robot)}, expected {reason}"


def answers_to_clouds(robot, begin, end):
    """How many clouds were sent in that time, how many of them were answered by one decision and how many by none,
    and how long the answers took, in order."""
    sent = {stamp: at for at, stamp in list(robot.scans) if begin <= at < end}
    answers = {}
    for at, stamp in list(robot.decisions):
        if stamp in sent:
            answers.setdefault(stamp, []).append(at)
    once = sum(len(times) == 1 for times in answers.values())
    delays_s = sorted(times[0] - sent[stamp] for stamp, times in answers.items())
    return len(sent), once, len(sent) - len(answers), delays_s


def no_cloud_is_lost(robot, _node):
    if not drive(robot):
        return False, f"it does not drive: {state(robot)}"
    time.sleep(1.0)
    begin = time.monotonic()
    time.sleep(10.0)
    sent, once, _, delays_s = answers_to_clouds(robot, begin, begin + 9.5)
    rate = sum(begin <= at < begin + 9.5 for at, _, _ in robot.commands) / 9.5
    median = 1e3 * delays_s[len(delays_s) // 2] if delays_s else float("nan")
    ok = sent > 80 and once == sent and rate > 45.0
    return ok, (
        f"{once} of {sent} clouds of 633 600 bytes were answered by one decision, "
        f"{median:.0f} ms after they were sent in the median; {rate:.0f} commands a second"
    )


def limits_hold(robot, _node):
    speeds = [v for _, v, _ in robot.commands]
    return max(speeds) <= 0.5 + 1e-9 and max(speeds) > 0.4, f"the fastest command is {max(speeds):.3f} of 0.5 m/s"


def scans_cease(robot, _node):
    return stops(robot, lambda: setattr(robot, "is_scanning", False), 0.35, "scan: Stale")


def odometry_ceases(robot, _node):
    return stops(robot, lambda: setattr(robot, "is_turning_wheels", False), 0.15, "odometry: Stale")


def imu_ceases(robot, _node):
    return stops(robot, lambda: setattr(robot, "is_feeling", False), 0.10, "IMU: Stale")


def clouds_are_cut(robot, _node):
    return stops(robot, lambda: setattr(robot, "is_cloud_whole", False), 0.35, "scan: Malformed")


def the_robot_leans(robot, _node):
    return stops(robot, lambda: setattr(robot, "roll", 0.6), 0.05, "tilted")


def the_odometry_jumps(robot, _node):
    return stops(robot, lambda: setattr(robot, "shift", 5.0), 0.05, "jumped")


def the_emergency_stop_is_pressed(robot, _node):
    # It is told at 10 Hz.
    return stops(robot, lambda: setattr(robot, "is_pressed", True), 0.10, "emergency stop is pressed")


def a_release_moves_nothing(robot, _node):
    robot.is_pressed = False
    time.sleep(3.0)
    began = time.monotonic()
    time.sleep(1.0)
    moved = [v for at, v, w in robot.commands if at > began and (v != 0.0 or w != 0.0)]
    return not moved and "Standby" in state(robot), f"{len(moved)} commands moved it; it is in {state(robot)}"


def it_arrives(robot, _node):
    arrived = lambda: robot.x > goal_x - 0.6 and "Standby" in state(robot) and not robot.is_driving()
    goal_x = robot.x + 3.0
    robot.shift = 2.0  # The odometry need not begin where the node's own frame does.
    time.sleep(3.0)
    until(lambda: "Standby" in state(robot), 10.0)
    robot.send_goal(goal_x + robot.shift, robot.y)
    ok = until(arrived, 30.0)
    return ok, f"the robot is {goal_x - robot.x:.2f} m from its goal, {state(robot)}"


def it_ends_with_zero(robot, node):
    if not drive(robot):
        return False, f"it does not drive: {state(robot)}"
    code = node.end()
    time.sleep(0.3)
    _, v, w = robot.commands[-1]
    return code == 0 and v == 0.0 and w == 0.0, f"it ended with status {code} and the command {v}, {w}"


def a_suspended_process_goes_on_standing(robot, node):
    """SIGSTOP of 1.5 s: nothing moves the robot after SIGCONT. The node ends, to be started anew, as its
    middleware does not survive this; systemd does so, and here the test."""
    if not drive(robot):
        return False, f"it does not drive: {state(robot)}"
    node.process.send_signal(signal.SIGSTOP)
    time.sleep(1.5)
    count = len(robot.commands)
    node.process.send_signal(signal.SIGCONT)
    code = node.process.wait(5)
    node.start()
    back = until(lambda: len(robot.commands) > count + 50, DISCOVERY_S)
    moved = [v for _, v, w in robot.commands[count:] if v != 0.0 or w != 0.0]
    return code == 1 and back and not moved, (
        f"it ended with status {code}; {len(moved)} of {len(robot.commands) - count} commands after it moved the robot"
    )


def killed_it_stands_until_a_goal(robot, node):
    if not drive(robot):
        return False, f"it does not drive: {state(robot)}"
    node.kill()
    count = len(robot.commands)
    node.start()
    back = until(lambda: len(robot.commands) > count + 100, DISCOVERY_S)
    moved = [v for _, v, w in robot.commands[count + 3 :] if v != 0.0 or w != 0.0]
    return back and not moved, f"{len(robot.commands) - count} commands later, {len(moved)} moved the robot"


def stamps_ahead_of_the_simulated_clock_stop_it(robot, node):
    """After all others: the node is begun anew with `use_sim_time`. The clock stands, and stamps go on. A simulation
    may stand for 5 s; then time passes without its clock, and all that comes is from the future."""
    if node.process.poll() is None:
        node.end()
    node.configure("node_name: mapless", "node_name: mapless\n    use_sim_time: true")
    robot.is_simulated, robot.diagnosis = True, None
    node.start()
    checked = stops(robot, lambda: setattr(robot, "is_simulated", False), 5.35, "Future")
    node.end()
    return checked


def in_order(robot):
    """Takes every fault back, and resets."""
    robot.is_scanning = robot.is_turning_wheels = robot.is_feeling = robot.is_cloud_whole = True
    robot.is_pressed, robot.roll = False, 0.0
    time.sleep(0.3)

    def is_well():
        if "Latched" in state(robot):
            robot.reset.publish(robot.messages.Bool(data=True))
        return state(robot).startswith(("Standby", "Driving"))

    until(is_well, 10.0)


def main(wire, checks):
    """Runs the checks whose names the command line gives, or all, with a robot on this wire."""
    program, config = sys.argv[1:3]
    names = sys.argv[3:]
    robot = Robot(wire)
    robot.start()
    folder = tempfile.TemporaryDirectory()
    node = Node([program], config, folder.name)
    failed = passed = 0
    try:
        for check in checks:
            if names and check.__name__ not in names:
                continue
            ok, found = check(robot, node)
            if not ok:
                # A busy machine loses a cloud or a moment now and then; what is wrong is wrong twice.
                print(f"again: {check.__name__}: {found}", flush=True)
                if node.process.poll() is not None:
                    node.start()
                in_order(robot)
                ok, found = check(robot, node)
            passed, failed = passed + ok, failed + (not ok)
            print(f"{'ok' if ok else 'FAILED'}: {check.__name__}: {found}", flush=True)
            if node.process.poll() is None and check is not the_emergency_stop_is_pressed:
                in_order(robot)
    finally:
        if node.process.poll() is None:
            node.kill()
        folder.cleanup()
    print(f"{failed} failed\n{passed} passed", flush=True)
    # Threads of a middleware abort an orderly end now and then.
    os._exit(failed > 0)
