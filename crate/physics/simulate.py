"""Drives the Husky in MuJoCo as its standard input says, and answers on its standard output.

First comes a line of JSON:

    {"rows", "columns", "cell_m", "friction", "robot", "sensor_m", "solids", "start"}

with what `Husky` takes; `ground` follows as rows × columns heights, 4 bytes each, little-endian. The answer is
the state in which the robot rests. Then each line "speed turn_rate seconds" is answered with the state after
it, until the input ends. A state is a line of numbers: x, y, z, roll, pitch, yaw, speed and turn rate of the
wheels, and 1 if anything but the wheels touches anything, else 0.
"""

import json
import sys

import numpy as np

from husky import Husky


def main():
    read, write = sys.stdin.buffer, sys.stdout
    task = json.loads(read.readline())
    shape = (task.pop("rows"), task.pop("columns"))
    ground = np.frombuffer(read.read(4 * shape[0] * shape[1]), dtype="<f4").reshape(shape)
    husky = Husky(ground=ground.astype(float), **task)
    answer(write, husky)
    for line in iter(read.readline, b""):
        speed_m_s, turn_rate_rad_s, seconds = map(float, line.split())
        husky.drive(speed_m_s, turn_rate_rad_s, seconds)
        answer(write, husky)


def answer(write, husky):
    print(*husky.pose(), *husky.wheels(), int(husky.body_touches()), file=write, flush=True)


if __name__ == "__main__":
    main()
