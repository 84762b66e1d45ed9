/*
 * Runs somebody's own planner: a module in JavaScript whose default export is a class with `decide` or a function, or one
 * in WebAssembly with the functions of crate/planner-template. It answers each question through a port.
 */

/** By which its lines are found in the trace of an error. */
const NAME = 'own-planner';
/** In the order in which WebAssembly is told them. */
const ROBOT = ['max_speed_m_s', 'max_turn_rate_rad_s', 'length_m', 'width_m', 'roll_limit_rad', 'pitch_limit_rad'];
const SENSOR = ['height_m', 'forward_m', 'left_m', 'roll_rad', 'pitch_rad', 'yaw_rad'];
const FUNCTIONS = ['points', 'decide', 'linear_m_s', 'angular_rad_s'];
const MIB = 1 << 20;
/** No planner needs more, and a memory that grows with each decision takes the whole tab down. */
const MOST_MIB = 256;

async function inJavaScript(source, model) {
  const named = `${source}\n//# sourceURL=${NAME}`;
  const { default: given } = await import(`data:text/javascript;charset=utf-8,${encodeURIComponent(named)}`);
  if (typeof given !== 'function') throw new Error('no default export: expected a class with decide(), or a function');
  if (typeof given.prototype?.decide === 'function') {
    const planner = new given(model);
    return (question) => planner.decide(question);
  }
  return (question) => given(question, model);
}

async function inWebAssembly(bytes, { robot, sensor }) {
  const { instance } = await WebAssembly.instantiate(bytes, {});
  const own = instance.exports;
  const missing = FUNCTIONS.filter((name) => typeof own[name] !== 'function');
  if (!(own.memory instanceof WebAssembly.Memory)) missing.push('memory');
  if (missing.length > 0) throw new Error(`no export ${missing.join(', ')}: expected those of crate/planner-template`);
  const check = () => {
    const mib = Math.ceil(own.memory.buffer.byteLength / MIB);
    if (mib > MOST_MIB) throw new Error(`its memory is ${mib} MiB: expected at most ${MOST_MIB} MiB`);
  };
  check();
  own.begin?.(...ROBOT.map((name) => robot[name]), ...SENSOR.map((name) => sensor[name]));
  return ({ points, time_s, elapsed_s, pose, goal }) => {
    const count = points.length / 3;
    // Making room may make the memory another one.
    const room = own.points(count);
    check();
    new Float32Array(own.memory.buffer, room, points.length).set(points);
    const { x, y, z, roll, pitch, yaw } = pose;
    own.decide(count, time_s, elapsed_s, x, y, z, roll, pitch, yaw, goal.x, goal.y, goal.heading_rad ?? Number.NaN);
    check();
    return { linear_m_s: own.linear_m_s(), angular_rad_s: own.angular_rad_s() };
  };
}

/** What went wrong, and in which line of the code where that is known. */
function faultOf(error) {
  const [, line] = /own-planner:(\d+):\d+/.exec(error?.stack ?? '') ?? [];
  const what = error instanceof Error ? `${error.name}: ${error.message}` : `thrown: ${String(error)}`;
  return line ? `${what} (line ${line})` : what;
}

self.onmessage = ({ data: { code, port } }) => {
  let decide;
  port.onmessage = async ({ data }) => {
    const began_ms = performance.now();
    try {
      if (data.model) {
        decide = await (typeof code === 'string' ? inJavaScript : inWebAssembly)(code, data.model);
        port.postMessage({ opened: true });
        return;
      }
      const { linear_m_s, angular_rad_s } = (await decide(data.question)) ?? {};
      port.postMessage({ linear_m_s, angular_rad_s, decision_ms: performance.now() - began_ms });
    } catch (error) {
      port.postMessage({ fault: faultOf(error) });
    }
  };
};
