/*
 * A planner of your own. For each scan it is asked
 * once, and answers with a command.
 * World: x east, y north, z up.
 * Robot and sensor: x ahead, y left, z up.
 * Metres, radians, seconds.
 * This one drives towards the goal, around
 * whatever rises steeply within 5 m.
 */
const [SECTORS, REACH_M, STEEPEST, LEAST_RISE_M] = [72, 5, 0.3, 0.25];
const WIDTH = (2 * Math.PI) / SECTORS;

export default class Planner {
  #heading = 0;

  /** Both with the names of a scenario file. */
  constructor({ sensor, robot }) {
    [this.sensor, this.robot] = [sensor, robot];
  }

  /** `points`: x, y, z of each return, in the
   * sensor's frame, one after the other. */
  decide({ points, pose, goal }) {
    const wrapped = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));
    const bearing = wrapped(Math.atan2(goal.y - pose.y, goal.x - pose.x) - pose.yaw);
    const steepness = new Float64Array(SECTORS);
    for (let at = 0; at < points.length; at += 3) {
      const [x, y, z] = [points[at], points[at + 1], points[at + 2]];
      const distance = Math.hypot(x, y);
      if (distance > REACH_M) continue;
      // The robot tilts with its ground; slopes
      // are counted from the horizontal.
      const rise = z + this.sensor.height_m + x * Math.sin(pose.pitch) + y * Math.sin(pose.roll);
      if (Math.abs(rise) < LEAST_RISE_M) continue;
      // As wide as the robot seen from there.
      const half = Math.ceil(Math.atan2(this.robot.width_m / 2 + 0.2, distance) / WIDTH);
      const middle = Math.round(Math.atan2(y, x) / WIDTH);
      for (let sector = middle - half; sector <= middle + half; sector += 1) {
        const index = (sector + SECTORS) % SECTORS;
        steepness[index] = Math.max(steepness[index], Math.abs(rise) / distance);
      }
    }
    const cost = (sector) => {
      const angle = sector * WIDTH;
      const turns = Math.abs(wrapped(angle - bearing)) + 0.3 * Math.abs(wrapped(angle - this.#heading));
      // How far it would lean to the side there,
      // on ground as steep as here.
      const lean = Math.abs(pose.roll * Math.cos(angle) - pose.pitch * Math.sin(angle));
      return turns + 4 * lean + (steepness[sector] > STEEPEST ? 10 : 3 * steepness[sector]);
    };
    const best = [...steepness.keys()].reduce((one, other) => (cost(other) < cost(one) ? other : one));
    this.#heading = wrapped(best * WIDTH);
    const angular_rad_s = Math.max(-1, Math.min(1, 1.5 * this.#heading)) * this.robot.max_turn_rate_rad_s;
    return { linear_m_s: this.robot.max_speed_m_s * Math.max(0, Math.cos(this.#heading)) ** 2, angular_rad_s };
  }
}
