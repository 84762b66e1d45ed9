//! The physics engine: a program that is told a world, then commands, and answers with states. What is said
//! stands in `simulate.py`.

use std::io::{BufRead, BufReader, BufWriter, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context as _, bail, ensure};
use glam::DVec3;
use mapless::Pose;
use mapless_trials::{Navigator, Trial};
use mapless_world::{DriveCommand, HeightField, RobotConfig, Shape, Solid};

/// Where the robot is after a command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct State {
    /// On the ground between the wheels, in the world, metres.
    pub(crate) position_m: DVec3,
    /// Radians; the yaw counts whole turns.
    pub(crate) roll_rad: f64,
    pub(crate) pitch_rad: f64,
    pub(crate) yaw_rad: f64,
    /// What the wheels do, as the motion of a body that does not slip.
    pub(crate) wheels: DriveCommand,
    /// Whether anything but the wheels touches anything.
    pub(crate) body_touches: bool,
}

impl State {
    /// The pose in it.
    pub(crate) fn pose(&self) -> Pose {
        Pose::from_roll_pitch_yaw(self.position_m, self.roll_rad, self.pitch_rad, self.yaw_rad)
    }
}

/// The world that the engine is told first.
#[derive(serde::Serialize)]
struct World<'a> {
    rows: usize,
    columns: usize,
    cell_m: f64,
    friction: f64,
    robot: &'a RobotConfig,
    sensor_m: [f64; 3],
    solids: Vec<Geometry>,
    /// x, y, z, roll, pitch, yaw.
    start: [f64; 6],
}

/// A solid in the engine's words.
#[derive(Debug, PartialEq, serde::Serialize)]
struct Geometry {
    #[serde(rename = "type")]
    kind: &'static str,
    centre_m: [f64; 3],
    size_m: Vec<f64>,
    yaw_rad: f64,
}

impl Geometry {
    fn of(solid: &Solid) -> Self {
        let (kind, size_m, yaw_rad) = match solid.shape {
            Shape::Cuboid { half_m, sin_cos_yaw: (sin, cos) } => {
                ("box", half_m.to_array().to_vec(), libm::atan2(sin, cos))
            }
            Shape::Cylinder { radius_m, half_height_m } => ("cylinder", vec![radius_m, half_height_m], 0.0),
            Shape::Ball { radius_m } => ("sphere", vec![radius_m], 0.0),
        };
        Self { kind, centre_m: solid.centre_m.to_array(), size_m, yaw_rad }
    }
}

/// A running engine.
#[derive(Debug)]
pub(crate) struct Engine {
    child: Child,
    commands: BufWriter<ChildStdin>,
    states: BufReader<ChildStdout>,
}

impl Engine {
    /// Starts the program `command` with the world of a trial; gives the state in which the robot rests.
    ///
    /// # Errors
    /// An object that walks, and a program that does not start or answer.
    pub(crate) fn start<N: Navigator>(
        command: &[String],
        trial: &Trial<N>,
        robot: &RobotConfig,
        friction: f64,
    ) -> anyhow::Result<(Self, State)> {
        if let Some(walker) = trial.objects().moving().next() {
            bail!(
                "objects[{}] walks: expected objects that stand, as the physics engine moves none",
                walker.object + 1
            );
        }
        let (program, arguments) = command.split_first().context("COMMAND: expected a program")?;
        let mut child = Command::new(program)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| program.clone())?;
        let commands = BufWriter::new(child.stdin.take().context("the engine has no input")?);
        let states = BufReader::new(child.stdout.take().context("the engine has no output")?);
        let mut engine = Self { child, commands, states };
        let told = tell_world(&mut engine.commands, trial, robot, friction);
        let state = told.and_then(|()| read_state(&mut engine.states)).with_context(|| engine.end())?;
        Ok((engine, state))
    }

    /// Drives on by a command for so many seconds.
    ///
    /// # Errors
    /// An engine that has ended, or whose answer is not a state.
    pub(crate) fn drive(&mut self, command: DriveCommand, seconds: f64) -> anyhow::Result<State> {
        let told = tell_command(&mut self.commands, command, seconds);
        told.and_then(|()| read_state(&mut self.states)).with_context(|| self.end())
    }

    /// How the program ended, for an error.
    fn end(&mut self) -> String {
        // It has no more to say; a program that hangs is ended.
        let _ = self.child.kill();
        let status = self.child.wait();
        let status = status.map_or_else(|error| error.to_string(), |status| status.to_string());
        format!("the physics engine ({status}; what it said of it stands above)")
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn tell_world<N: Navigator>(
    to: &mut impl Write,
    trial: &Trial<N>,
    robot: &RobotConfig,
    friction: f64,
) -> anyhow::Result<()> {
    let [x, y, z, roll, pitch, yaw, ..] = trial.motion();
    let field: &HeightField = trial.field();
    let world = World {
        rows: field.rows(),
        columns: field.columns(),
        cell_m: field.cell_m(),
        friction,
        robot,
        sensor_m: trial.sensor().config().place_on_robot_m().to_array(),
        solids: trial.objects().standing().map(Geometry::of).collect(),
        start: [x, y, z, roll, pitch, yaw],
    };
    serde_json::to_writer(&mut *to, &world)?;
    to.write_all(b"\n")?;
    for height_m in field.heights_m() {
        to.write_all(&height_m.to_le_bytes())?;
    }
    to.flush()?;
    Ok(())
}

fn tell_command(to: &mut impl Write, command: DriveCommand, seconds: f64) -> anyhow::Result<()> {
    let DriveCommand { speed_m_s, turn_rate_rad_s } = command;
    writeln!(to, "{speed_m_s} {turn_rate_rad_s} {seconds}")?;
    to.flush()?;
    Ok(())
}

fn read_state(from: &mut impl BufRead) -> anyhow::Result<State> {
    let mut line = String::new();
    ensure!(from.read_line(&mut line)? > 0, "it ended before it answered");
    state(&line).with_context(|| format!("{:?}: expected nine finite numbers", line.trim_end()))
}

fn state(line: &str) -> Option<State> {
    let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let [x, y, z, roll_rad, pitch_rad, yaw_rad, speed_m_s, turn_rate_rad_s, touches] =
        numbers.try_into().ok()?;
    let is_finite = [x, y, z, roll_rad, pitch_rad, yaw_rad, speed_m_s, turn_rate_rad_s, touches]
        .iter()
        .all(|number| number.is_finite());
    is_finite.then_some(State {
        position_m: DVec3::new(x, y, z),
        roll_rad,
        pitch_rad,
        yaw_rad,
        wheels: DriveCommand { speed_m_s, turn_rate_rad_s },
        body_touches: touches > 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless_trials::{Preset, Scenario};

    fn trial(objects: &str) -> Trial {
        let text = format!(
            "terrain = \"t\"\nstart = [2.0, 1.5, 0.5]\ngoal = [4.0, 1.5]\nseed = 1\n[sensor]\nheight_m = 0.9\n{objects}"
        );
        let scenario = Scenario::parse("t", &text).unwrap();
        let heights = (0..21 * 11).map(|i| (i % 21) as f32 * 0.05).collect();
        let field = HeightField::new(21, 11, 0.25, heights).unwrap();
        Trial::new(field, &scenario, Preset::Default, 1).unwrap()
    }

    const BOX: &str =
        "[[objects]]\nkind = \"box\"\nat = [4.5, 2.0]\nsize_m = [0.4, 0.6, 1.0]\nyaw_rad = 0.7\n";

    #[test]
    fn the_world_is_a_line_and_the_heights_row_by_row_from_the_south() {
        let mut told = Vec::new();
        tell_world(&mut told, &trial(BOX), &RobotConfig::default(), 0.7).unwrap();
        let end = told.iter().position(|&byte| byte == b'\n').unwrap();
        let (line, heights) = (&told[..end], &told[end + 1..]);
        let world: serde_json::Value = serde_json::from_slice(line).unwrap();
        assert_eq!((&world["rows"], &world["columns"]), (&11.into(), &21.into()));
        assert_eq!((&world["cell_m"], &world["friction"]), (&0.25.into(), &0.7.into()));
        assert_eq!((&world["robot"]["track_m"], &world["sensor_m"][2]), (&0.571.into(), &0.9.into()));
        let start: Vec<f64> = serde_json::from_value(world["start"].clone()).unwrap();
        assert_eq!((start[0], start[1], start[5]), (2.0, 1.5, 0.5));
        assert!((start[2] - 0.4).abs() < 1e-6 && start[3] < -0.05 && start[4] > 0.1, "{start:?}");
        let solid = &world["solids"][0];
        assert_eq!(solid["type"], "box");
        assert_eq!(solid["size_m"][0], 0.2);
        assert!((solid["yaw_rad"].as_f64().unwrap() - 0.7).abs() < 1e-12);
        let heights: Vec<f32> =
            heights.chunks(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect();
        assert_eq!((heights.len(), heights[20], heights[21]), (231, 1.0, 0.0));
    }

    #[test]
    fn every_shape_has_a_geometry() {
        let of = |shape| {
            Geometry::of(&Solid { centre_m: DVec3::new(1.0, 2.0, 3.0), shape, object: 0, is_grounded: true })
        };
        let post = of(Shape::Cylinder { radius_m: 0.1, half_height_m: 0.8 });
        assert_eq!((post.kind, post.size_m, post.centre_m), ("cylinder", vec![0.1, 0.8], [1.0, 2.0, 3.0]));
        let rock = of(Shape::Ball { radius_m: 0.3 });
        assert_eq!((rock.kind, rock.size_m), ("sphere", vec![0.3]));
    }

    #[test]
    fn a_command_keeps_every_bit_and_a_state_is_nine_numbers() {
        let command = DriveCommand { speed_m_s: 0.1 + 0.2, turn_rate_rad_s: -1e-9 };
        let mut told = Vec::new();
        tell_command(&mut told, command, 0.01).unwrap();
        assert_eq!(String::from_utf8(told).unwrap(), "0.30000000000000004 -0.000000001 0.01\n");

        let read = |text: &str| read_state(&mut text.as_bytes());
        let state = read("1 2 3 0.1 -0.2 7.5 0.4 0.3 1\n").unwrap();
        assert_eq!(state.position_m, DVec3::new(1.0, 2.0, 3.0));
        assert_eq!((state.roll_rad, state.pitch_rad, state.yaw_rad), (0.1, -0.2, 7.5));
        assert_eq!(state.wheels, DriveCommand { speed_m_s: 0.4, turn_rate_rad_s: 0.3 });
        assert!(state.body_touches);
        for bad in ["1 2 3\n", "1 2 3 0.1 -0.2 nan 0.4 0.3 0\n", "Traceback\n"] {
            assert!(read(bad).unwrap_err().to_string().ends_with("expected nine finite numbers"), "{bad}");
        }
        assert_eq!(read("").unwrap_err().to_string(), "it ended before it answered");
    }

    #[test]
    fn what_walks_is_refused_and_a_program_that_ends_is_told_of() {
        let walker = "[[objects]]\nkind = \"post\"\nat = [4.5, 2.0]\nradius_m = 0.2\nheight_m = 1.7\n\
            walk = { path = [[4.5, 1.0]], speed_m_s = 1.0 }\n";
        let start = |objects: &str, program: &str| {
            let error = Engine::start(&[program.to_owned()], &trial(objects), &RobotConfig::default(), 0.9)
                .unwrap_err();
            format!("{error:#}")
        };
        assert!(start(&format!("{BOX}{walker}"), "true").starts_with("objects[2] walks: expected objects"));
        assert!(start(BOX, "no such program").contains("no such program"));
        if cfg!(unix) {
            assert!(start(BOX, "true").contains("the physics engine ("), "{}", start(BOX, "true"));
        }
    }
}
