"""Runs `mapless-node` with a robot of Cyclone DDS, a second vendor, and checks what it does; prints the number that passed.

    check_cyclone.py PROGRAM CONFIG [CHECK ...]
"""

import checks
from robot import NAMESPACE
from wire_cyclone import Wire

CHECKS = (
    checks.no_cloud_is_lost,
    checks.limits_hold,
    checks.scans_cease,
    checks.odometry_ceases,
    checks.imu_ceases,
    checks.clouds_are_cut,
    checks.the_robot_leans,
    checks.the_odometry_jumps,
    checks.the_emergency_stop_is_pressed,
    checks.a_release_moves_nothing,
    checks.it_arrives,
    checks.a_suspended_process_goes_on_standing,
    checks.killed_it_stands_until_a_goal,
    checks.it_ends_with_zero,
)


if __name__ == "__main__":
    checks.main(Wire(NAMESPACE, checks.DOMAIN), CHECKS)
