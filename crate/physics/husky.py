"""A Clearpath Husky A200 on a height field in MuJoCo.

SI units and radians. World: x east, y north, z up, with the origin at the south-west corner of the ground.
Robot: x forward, y left, z up, with the origin on the ground in the middle between the wheels; pitch is
positive nose-up, roll with the left side up.
"""

import math

import mujoco
import numpy as np

STEP_S = 0.002
# Chassis and wheel of husky_description (base_link 46.034 kg, wheels 2.637 kg each); the rest of the 59.5 kg
# are the mast, the sensor and what is fixed to the deck.
CHASSIS_KG = 46.034
CHASSIS_INERTIA_KG_M2 = (0.6022, 1.7386, 2.0296)
CHASSIS_CENTRE_M = 0.194
WHEEL_KG = 2.637
MAST_KG = 2.918
# A side shares its torque as on a common belt: one wheel may have more than half of it.
WHEEL_TORQUE_NM = 80.0
SIDE_TORQUE_NM = 100.0
# PI control of the wheel speed; the integral holds a robot on a slope.
PROPORTIONAL_NM_S = 40.0
INTEGRAL_NM = 300.0
# Assumed: half of a rotor of 1e-4 kg m² behind the A200's gear of 78.7 : 1.
ARMATURE_KG_M2 = 0.3
# The tyres give: 8 mm under a quarter of the robot, some 18 kN/m. Stiffer ones hop when they skid, and the
# robot then turns by a third to two thirds of what it should.
TYRE_SOLREF = "0.05 1"
TYRE_SOLIMP = "0.3 0.9 0.02"
# A differential drive's wheels must turn faster than those of a robot that does not skid.
SEPARATION_MULTIPLIER = 1.875
# A robot is put down this high, and comes to rest before it is told to drive.
DROP_M = 0.01
REST_S = 1.0

# Front left, front right, rear left, rear right: ahead, to the left.
WHEELS = ((1, 1), (1, -1), (-1, 1), (-1, -1))


class Husky:
    """The robot and its world.

    `ground` is an array of heights, a row for each y from south to north, `cell_m` apart. `robot` and
    `sensor_m` are the dimensions and limits of `RobotConfig` and the place of the sensor in the robot frame.
    `solids` are boxes, cylinders and spheres, as `simulate.py` reads them. `start` is x, y, z, roll, pitch
    and yaw.
    """

    def __init__(self, ground, cell_m, friction, robot, sensor_m, solids, start):
        self.robot = robot
        self.model = _model(ground, cell_m, friction, robot, sensor_m, solids)
        self.data = mujoco.MjData(self.model)
        self.body = [self.model.body(name).id for name in ("chassis", "mast")]
        self.integrals_nm = [0.0] * 4
        self.speed_m_s = self.turn_rate_rad_s = 0.0
        self.yaw_rad = start[5]
        self._put(start)
        self.drive(0.0, 0.0, REST_S)

    def _put(self, start):
        x, y, z, roll, pitch, yaw = start
        quaternion = np.zeros(4)
        # MuJoCo's extrinsic x, y, z is yaw, then pitch, then roll; its pitch is positive nose-down.
        mujoco.mju_euler2Quat(quaternion, np.array([roll, -pitch, yaw]), "XYZ")
        self.data.qpos[:3] = [x, y, z + DROP_M]
        self.data.qpos[3:7] = quaternion
        mujoco.mj_forward(self.model, self.data)

    def drive(self, speed_m_s, turn_rate_rad_s, seconds):
        """Drives on by a command for some time, a whole number of steps."""
        robot = self.robot
        clamp = lambda value, most: max(-most, min(most, value))
        speed_m_s = clamp(speed_m_s, robot["max_speed_m_s"])
        turn_rate_rad_s = clamp(turn_rate_rad_s, robot["max_turn_rate_rad_s"])
        more_m_s = robot["max_acceleration_m_s2"] * STEP_S
        more_rad_s = robot["max_turn_acceleration_rad_s2"] * STEP_S
        half_m = SEPARATION_MULTIPLIER * robot["track_m"] / 2.0
        for _ in range(round(seconds / STEP_S)):
            self.speed_m_s += clamp(speed_m_s - self.speed_m_s, more_m_s)
            self.turn_rate_rad_s += clamp(turn_rate_rad_s - self.turn_rate_rad_s, more_rad_s)
            left = (self.speed_m_s - self.turn_rate_rad_s * half_m) / robot["wheel_radius_m"]
            right = (self.speed_m_s + self.turn_rate_rad_s * half_m) / robot["wheel_radius_m"]
            self.data.ctrl[:] = self._torques_nm(left, right)
            mujoco.mj_step(self.model, self.data)

    def _torques_nm(self, left_rad_s, right_rad_s):
        rates = self.data.qvel[6:10].tolist()
        wanted = (left_rad_s, right_rad_s, left_rad_s, right_rad_s)
        torques = [0.0] * 4
        for wheel in range(4):
            error = wanted[wheel] - rates[wheel]
            integral = self.integrals_nm[wheel] + INTEGRAL_NM * error * STEP_S
            # No more is summed up than can be given.
            self.integrals_nm[wheel] = max(-WHEEL_TORQUE_NM, min(WHEEL_TORQUE_NM, integral))
            torque = PROPORTIONAL_NM_S * error + self.integrals_nm[wheel]
            torques[wheel] = max(-WHEEL_TORQUE_NM, min(WHEEL_TORQUE_NM, torque))
        for front, rear in ((0, 2), (1, 3)):
            both = abs(torques[front] + torques[rear])
            if both > SIDE_TORQUE_NM:
                torques[front] *= SIDE_TORQUE_NM / both
                torques[rear] *= SIDE_TORQUE_NM / both
        return torques

    def axes(self):
        """Forward, left and up in the world."""
        return self.data.xmat[self.body[0]].reshape(3, 3).T

    def pose(self):
        """x, y, z, roll, pitch and yaw; the yaw counts whole turns."""
        forward, left, up = self.axes()
        yaw = math.atan2(forward[1], forward[0])
        self.yaw_rad += math.remainder(yaw - self.yaw_rad, math.tau)
        tilt = (math.atan2(left[2], up[2]), math.asin(max(-1.0, min(1.0, forward[2]))))
        return (*self.data.qpos[:3].tolist(), *tilt, self.yaw_rad)

    def wheels(self):
        """Speed and turn rate that a robot on these wheels would have if they did not slip."""
        rates = self.data.qvel[6:10]
        radius_m = self.robot["wheel_radius_m"]
        left, right = (rates[0] + rates[2]) / 2.0 * radius_m, (rates[1] + rates[3]) / 2.0 * radius_m
        return (left + right) / 2.0, (right - left) / (SEPARATION_MULTIPLIER * self.robot["track_m"])

    def body_touches(self):
        """Whether anything but the wheels touches anything."""
        owners = self.model.geom_bodyid[self.data.contact.geom]
        return bool(np.isin(owners, self.body).any())


def _model(ground, cell_m, friction, robot, sensor_m, solids):
    rows, columns = ground.shape
    low_m, high_m = float(ground.min()), float(ground.max())
    # MuJoCo wants some height and something beneath it.
    rise_m = max(high_m - low_m, 0.001)
    half_m = ((columns - 1) * cell_m / 2.0, (rows - 1) * cell_m / 2.0)
    model = mujoco.MjModel.from_xml_string(
        f"""
        <mujoco model="husky">
          <compiler angle="radian" autolimits="true"/>
          <option timestep="{STEP_S}" integrator="implicitfast" cone="elliptic" impratio="2"/>
          <default>
            <geom friction="{friction} 0.005 0.0001" condim="3"/>
            <default class="body"><geom type="box"/></default>
            <default class="wheel">
              <geom type="cylinder" priority="1" solref="{TYRE_SOLREF}" solimp="{TYRE_SOLIMP}"/>
            </default>
          </default>
          <asset>
            <hfield name="ground" nrow="{rows}" ncol="{columns}" size="{half_m[0]} {half_m[1]} {rise_m} 1"/>
          </asset>
          <worldbody>
            {_chassis(robot, sensor_m)}
            <geom type="hfield" hfield="ground" pos="{half_m[0]} {half_m[1]} {low_m}"/>
            {"".join(map(_solid, solids))}
          </worldbody>
          <actuator>{"".join(f'<motor joint="wheel{index}"/>' for index in range(4))}</actuator>
        </mujoco>
        """
    )
    model.hfield_data[:] = ((ground - low_m) / rise_m).ravel()
    return model


def _chassis(robot, sensor_m):
    """The parts of the body are those of `Body` in crate/world."""
    axle_m, side_m, end_m = robot["wheelbase_m"] / 2.0, robot["track_m"] / 2.0, robot["length_m"] / 2.0
    edge_m, top_m, radius_m = robot["width_m"] / 2.0, robot["height_m"], robot["wheel_radius_m"]
    inside_m, wheel_m = 2.0 * side_m - edge_m, edge_m - side_m
    belly_m, bumper_m = robot["ground_clearance_m"], robot["overhang_clearance_m"]
    ix, iy, iz = CHASSIS_INERTIA_KG_M2
    wheels = "".join(
        f"""
        <body pos="{ahead * axle_m} {aside * side_m} {radius_m}">
          <joint name="wheel{index}" type="hinge" axis="0 1 0" armature="{ARMATURE_KG_M2}"/>
          <geom class="wheel" size="{radius_m} {wheel_m}" quat="0.7071067811865476 0.7071067811865476 0 0"
            mass="{WHEEL_KG}"/>
        </body>"""
        for index, (ahead, aside) in enumerate(WHEELS)
    )
    mast_m = 0.05
    return f"""
        <body name="chassis">
          <freejoint/>
          <inertial pos="0 0 {CHASSIS_CENTRE_M}" mass="{CHASSIS_KG}" diaginertia="{ix} {iy} {iz}"/>
          {_part((-axle_m, axle_m), (-inside_m, inside_m), (belly_m, top_m))}
          {_part((axle_m, end_m), (-edge_m, edge_m), (bumper_m, top_m))}
          {_part((-end_m, -axle_m), (-edge_m, edge_m), (bumper_m, top_m))}
          <body name="mast">
            {_part(
                (sensor_m[0] - mast_m, sensor_m[0] + mast_m),
                (sensor_m[1] - mast_m, sensor_m[1] + mast_m),
                (top_m, max(top_m, sensor_m[2]) + 0.04),
                f'mass="{MAST_KG}"',
            )}
          </body>
          {wheels}
        </body>"""


def _part(x, y, z, more=""):
    centre, half = zip(*(((low + high) / 2.0, (high - low) / 2.0) for low, high in (x, y, z)))
    numbers = lambda values: " ".join(map(str, values))
    return f'<geom class="body" pos="{numbers(centre)}" size="{numbers(half)}" {more}/>'


def _solid(solid):
    numbers = lambda values: " ".join(map(str, values))
    yaw = solid.get("yaw_rad", 0.0)
    return (
        f'<geom type="{solid["type"]}" pos="{numbers(solid["centre_m"])}" size="{numbers(solid["size_m"])}" '
        f'euler="0 0 {yaw}"/>'
    )
