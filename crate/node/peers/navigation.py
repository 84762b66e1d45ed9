"""Checks of the action `navigate_to_pose` by rclpy's own client."""

import time

from action_msgs.msg import GoalStatus
from nav2_msgs.action import NavigateToPose

from checks import DISCOVERY_S, FAR_M, SLACK_S, state
from robot import until

# An answer is one tick of the node and a message either way.
ANSWERED_S = 0.2
# Codes of the node's results.
STOPPED, PREEMPTED = 9000, 9701


class Goal:
    """A goal that was sent: its answer, feedback and result, and when they came."""

    def __init__(self, client, x, y, frame_id="odom"):
        goal = NavigateToPose.Goal()
        goal.pose.header.frame_id = frame_id
        goal.pose.pose.position.x, goal.pose.pose.position.y = float(x), float(y)
        goal.pose.pose.orientation.w = 1.0
        self.feedback, self.handle, self.result = [], None, None
        self.sent = time.monotonic()
        future = client.send_goal_async(goal, feedback_callback=lambda m: self.feedback.append(m.feedback))
        future.add_done_callback(self.hear_answer)

    def hear_answer(self, future):
        self.answered_after_s = time.monotonic() - self.sent
        self.handle = future.result()
        if self.handle.accepted:
            self.handle.get_result_async().add_done_callback(self.hear_result)

    def hear_result(self, future):
        self.ended = time.monotonic()
        self.result = future.result()

    def is_accepted(self, within_s=10.0):
        until(lambda: self.handle is not None, within_s)
        return self.handle is not None and self.handle.accepted

    def has_ended(self, within_s):
        return until(lambda: self.result is not None, within_s)

    def told(self):
        """Status, code and text of its result."""
        result = self.result.result
        return self.result.status, result.error_code, result.error_msg


def client_of(robot):
    return robot.wire.action_client(NavigateToPose, "navigate_to_pose")


def drive(robot, client):
    """A far goal that the robot drives to; it is given until it is taken."""
    goals = []

    def drives():
        if not goals or (goals[-1].handle is not None and not goals[-1].handle.accepted):
            goals.append(Goal(client, robot.x + robot.shift + FAR_M, robot.y))
            goals[-1].is_accepted()
        return robot.is_driving()

    return goals[-1] if until(drives, DISCOVERY_S) else None


def first_stop(robot, after):
    """How long after a moment the first zero came, and how often a command moved the robot after it."""
    stop = lambda: next((at for at, v, w in robot.commands if at > after and v == 0.0 and w == 0.0), None)
    if not until(lambda: stop() is not None, 3.0):
        return None, 0
    time.sleep(0.5)
    moved = sum(at > stop() and (v != 0.0 or w != 0.0) for at, v, w in list(robot.commands))
    return stop() - after, moved


def an_action_succeeds(robot, _node):
    client = client_of(robot)
    if not client.wait_for_server(DISCOVERY_S):
        return False, "the action was not found"
    until(lambda: state(robot).startswith("Standby"), 10.0)
    goal = Goal(client, robot.x + robot.shift + 3.0, robot.y)
    if not goal.is_accepted() or not goal.has_ended(30.0):
        return False, f"{'not accepted' if goal.handle is None else 'no result'}: {state(robot)}"
    distances = [feedback.distance_remaining for feedback in goal.feedback]
    frames = {feedback.current_pose.header.frame_id for feedback in goal.feedback}
    ok = (
        goal.told() == (GoalStatus.STATUS_SUCCEEDED, 0, "")
        and len(distances) >= 3
        and distances[0] > 2.0
        and distances[-1] < 1.0
        and distances == sorted(distances, reverse=True)
        and frames == {"odom"}
    )
    return ok, f"{goal.told()}; {len(distances)} feedbacks, {distances[0]:.2f} to {distances[-1]:.2f} m"


def an_action_in_another_frame_is_rejected(robot, _node):
    goal = Goal(client_of(robot), robot.x + 3.0, robot.y, frame_id="nowhere")
    ok = not goal.is_accepted() and goal.handle is not None and not robot.is_driving()
    return ok, f"{'rejected' if ok else 'not rejected'}: {state(robot)}"


def a_cancelled_action_stops(robot, _node):
    goal = drive(robot, client_of(robot))
    if goal is None:
        return False, f"it does not drive: {state(robot)}"
    began = time.monotonic()
    goal.handle.cancel_goal_async()
    took, moved = first_stop(robot, began)
    ended = goal.has_ended(5.0)
    ok = took is not None and took < 0.1 + SLACK_S and not moved and ended and goal.told()[0] == GoalStatus.STATUS_CANCELED
    return ok, f"zero after {took} s of 0.1; {moved} commands moved it then; {goal.told() if ended else 'no result'}"


def a_later_action_pre_empts(robot, _node):
    client = client_of(robot)
    before = drive(robot, client)
    if before is None:
        return False, f"it does not drive: {state(robot)}"
    later = Goal(client, robot.x + robot.shift + 4.0, robot.y)
    if not later.is_accepted() or not before.has_ended(5.0):
        return False, f"no answer or no result: {state(robot)}"
    ended_after_s = before.ended - later.sent
    reached = later.has_ended(30.0) and later.told()[0] == GoalStatus.STATUS_SUCCEEDED
    ok = (
        later.answered_after_s < ANSWERED_S + SLACK_S
        and ended_after_s < ANSWERED_S + SLACK_S
        and before.told()[:2] == (GoalStatus.STATUS_ABORTED, PREEMPTED)
        and reached
    )
    return ok, (
        f"answered after {later.answered_after_s:.3f} s, the old one ended after {ended_after_s:.3f} s as {before.told()}; "
        f"the later one {'was' if reached else 'was not'} reached"
    )


def a_stop_aborts_the_action(robot, _node):
    goal = drive(robot, client_of(robot))
    if goal is None:
        return False, f"it does not drive: {state(robot)}"
    robot.roll = 0.6
    ended = goal.has_ended(5.0)
    # The diagnostics tell it later than the result does.
    until(lambda: "tilted" in state(robot), 3.0)
    ok = ended and goal.told()[:2] == (GoalStatus.STATUS_ABORTED, STOPPED) and "tilted" in goal.told()[2]
    return ok, f"{goal.told() if ended else 'no result'}"


def an_action_after_a_restart(robot, node):
    """The node is killed with a goal in service: it comes back without one, and takes the next."""
    client = client_of(robot)
    if drive(robot, client) is None:
        return False, f"it does not drive: {state(robot)}"
    node.kill()
    count = len(robot.commands)
    node.start()
    if not until(lambda: len(robot.commands) > count + 100, DISCOVERY_S):
        return False, "it did not come back"
    moved = [v for _, v, w in robot.commands[count + 3 :] if v != 0.0 or w != 0.0]
    drives = drive(robot, client) is not None
    return drives and not moved, f"{len(moved)} commands moved it before the goal; {state(robot)} after it"


CHECKS = (
    an_action_succeeds,
    an_action_in_another_frame_is_rejected,
    a_cancelled_action_stops,
    a_later_action_pre_empts,
    a_stop_aborts_the_action,
    an_action_after_a_restart,
)
