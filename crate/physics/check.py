"""Checks the Husky in MuJoCo on ground whose answers are known; prints the number that passed."""

import math
import sys

import numpy as np

from husky import Husky

# The defaults of `RobotConfig` and the sensor's place.
ROBOT = {
    "max_speed_m_s": 1.0,
    "max_turn_rate_rad_s": 1.0,
    "max_acceleration_m_s2": 1.0,
    "max_turn_acceleration_rad_s2": 2.0,
    "length_m": 0.99,
    "wheelbase_m": 0.512,
    "track_m": 0.571,
    "wheel_radius_m": 0.165,
    "width_m": 0.685,
    "ground_clearance_m": 0.13,
    "height_m": 0.39,
    "overhang_clearance_m": 0.18,
}
SENSOR_M = (0.0, 0.0, 0.8)
CELL_M = 0.1
SIDE = 301
MIDDLE_M = CELL_M * (SIDE - 1) / 2.0


def slope(degrees):
    """Ground that rises to the east."""
    rise = CELL_M * math.tan(math.radians(degrees))
    return np.tile(np.arange(SIDE) * rise, (SIDE, 1))


def placed(ground, degrees=0.0, yaw=0.0, friction=0.9, solids=(), height_m=None):
    """A robot in the middle of ground that rises to the east."""
    rise = math.tan(math.radians(degrees))
    pitch = math.atan(rise * math.cos(yaw))
    roll = math.atan(-rise * math.sin(yaw) * math.cos(pitch))
    height_m = float(ground[SIDE // 2, SIDE // 2]) if height_m is None else height_m
    return Husky(
        ground, CELL_M, friction, ROBOT, SENSOR_M, solids, (MIDDLE_M, MIDDLE_M, height_m, roll, pitch, yaw)
    )


def driven(husky, speed_m_s, turn_rate_rad_s, seconds):
    """The way along the body and to its left, in metres, and the turn, while a command is obeyed."""
    ahead = left = turn = 0.0
    before = husky.pose()
    for _ in range(round(seconds / 0.1)):
        husky.drive(speed_m_s, turn_rate_rad_s, 0.1)
        after = husky.pose()
        way = np.subtract(after[:3], before[:3])
        forward, aside, _ = husky.axes()
        ahead += way @ forward
        left += way @ aside
        turn += after[5] - before[5]
        before = after
    return ahead, left, turn


def straight_on_level_ground():
    husky = placed(slope(0.0))
    husky.drive(0.8, 0.0, 5.0)
    # 0.8 m/s for 5 s, less what is lost while the speed grows by 1 m/s².
    way = husky.pose()[0] - MIDDLE_M
    return 3.55 < way < 3.70, f"straight: {way:.2f} of 3.68 m"


def turn_on_level_ground():
    husky = placed(slope(0.0))
    for _ in range(5):
        husky.drive(0.0, 0.8, 1.0)
        yaw = husky.pose()[5]
    return 3.5 < yaw < 4.3, f"turn on the spot: {yaw:.2f} of 3.84 rad"


def rests_on_a_slope():
    husky = placed(slope(20.0), 20.0)
    x, _, _, roll, pitch, _ = husky.pose()
    husky.drive(0.0, 0.0, 5.0)
    slid = husky.pose()[0] - x
    steep = math.degrees(pitch)
    is_right = abs(slid) < 0.05 and abs(steep - 20.0) < 1.5 and abs(roll) < 0.01
    return is_right, f"rest at 20°: slid {slid:.3f} m, pitch {steep:.1f}°"


def signs_follow_the_conventions():
    _, _, _, roll, pitch, yaw = placed(slope(20.0), 20.0, yaw=-math.pi / 2.0).pose()
    is_right = math.degrees(roll) > 18.0 and abs(pitch) < 0.02 and abs(yaw + math.pi / 2.0) < 0.02
    return is_right, f"facing south with the hill on its left: roll {math.degrees(roll):.1f}°"


def climbed(degrees, friction):
    husky = placed(slope(degrees), degrees, friction=friction)
    x = husky.pose()[0]
    husky.drive(0.5, 0.0, 5.0)
    return (husky.pose()[0] - x) / math.cos(math.radians(degrees))


def climbs_what_friction_allows():
    steep, wet, wet_steep = climbed(38.0, 0.9), climbed(20.0, 0.4), climbed(30.0, 0.4)
    is_right = steep > 1.8 and wet > 1.3 and wet_steep < 0.2
    at_0_4 = f"at 0.4 up 20°: {wet:.2f} m, up 30°: {wet_steep:.2f} m"
    return is_right, f"2.4 m up 38° at friction 0.9: {steep:.2f} m; {at_0_4}"


def slope_slip():
    """Speed up and down 20° over the commanded one."""
    shares = []
    for yaw in (0.0, math.pi):
        husky = placed(slope(20.0), 20.0, yaw)
        driven(husky, 0.6, 0.0, 2.0)
        shares.append(driven(husky, 0.6, 0.0, 3.0)[0] / 1.8)
    up, down = shares
    return 0.9 < up < down < 1.1, f"20°: {up:.3f} of the speed up, {down:.3f} down"


def side_slip():
    """What a robot that drives along 20° slides downhill."""
    husky = placed(slope(20.0), 20.0, math.pi / 2.0)
    driven(husky, 0.6, 0.0, 2.0)
    ahead, left, _ = driven(husky, 0.6, 0.0, 3.0)
    return 0.0 < left / ahead < 0.1, f"along 20°: slides {left / ahead:.3f} m a metre down"


# `side_slope_turn` of the reality preset `field`.
SIDE_SLOPE_TURN = 0.45


def turns_on_a_side_slope():
    """Turns of 1.2 rad either way, half of it uphill of the contour and half below, as a share and its slide."""
    found, passed = [], True
    for degrees in (5.0, 10.0, 15.0, 20.0, 25.0):
        turned, slid = [], []
        for speed in (0.0, 0.4, 0.8):
            for side in (1.0, -1.0):
                husky = placed(slope(degrees), degrees, math.pi / 2.0 - side)
                driven(husky, speed, 0.4 * side, 1.0)
                _, left, turn = driven(husky, speed, 0.4 * side, 3.0)
                turned.append(abs(turn) / 1.2)
                slid.append(left / abs(turn))
        expected = 1.0 + SIDE_SLOPE_TURN * math.tan(math.radians(degrees))
        passed = passed and abs(np.mean(turned) - expected) < 0.05 and 0.02 < np.mean(slid) < 0.5
        found.append(f"{degrees:.0f}°: {np.mean(turned):.2f} ({min(turned):.2f} to {max(turned):.2f}), {np.mean(slid):.2f}")
    return passed, "turned over commanded, slid down in m a radian: " + "; ".join(found)


def belly_on_a_ridge():
    ground = slope(0.0)
    free = placed(ground).body_touches()
    ground[:, SIDE // 2] = 0.2
    husky = placed(ground, height_m=0.08)
    husky.drive(0.5, 0.0, 5.0)
    way = husky.pose()[0] - MIDDLE_M
    is_right = husky.body_touches() and not free and way < 0.1
    return is_right, f"a ridge of 0.2 m carries the belly: {way:.2f} m in 5 s"


def a_wall_holds():
    centre_m = [MIDDLE_M + 2.0, MIDDLE_M, 0.5]
    wall = {"type": "box", "centre_m": centre_m, "size_m": [0.2, 2.0, 0.5], "yaw_rad": 0.0}
    husky = placed(slope(0.0), solids=[wall])
    husky.drive(0.5, 0.0, 8.0)
    way = husky.pose()[0] - MIDDLE_M
    is_right = abs(way - 1.305) < 0.05 and husky.body_touches()
    return is_right, f"stopped by a wall after {way:.2f} of 1.30 m"


CHECKS = (
    straight_on_level_ground,
    turn_on_level_ground,
    rests_on_a_slope,
    signs_follow_the_conventions,
    climbs_what_friction_allows,
    slope_slip,
    side_slip,
    turns_on_a_side_slope,
    belly_on_a_ridge,
    a_wall_holds,
)


def main():
    failed = 0
    for check in CHECKS:
        passed, found = check()
        failed += not passed
        print(f"{'ok' if passed else 'FAILED'}: {found}", flush=True)
    print(f"{failed} failed\n{len(CHECKS) - failed} passed")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
