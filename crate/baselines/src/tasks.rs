//! Generated tasks: a terrain, a start and a goal by seed, solved by the oracle.
//!
//! Start and goal lie 35 to 75 m apart on ground that is safe with every heading. Half of the starts face the
//! goal roughly, the others any direction. Tasks that the oracle cannot solve are drawn again, so every task
//! has a safe path. Task K of a seed is the same however many tasks there are.

use crate::known_world::KnownWorld;
use crate::oracle::{OracleConfig, OracleError, OraclePath, PlanPose, SafePoses};
use glam::DVec2;
use mapless_terrain::generate::{Family, terrain_recipe};
use mapless_terrain::{Fault, Terrain, TerrainError, load_recipe};
use mapless_world::random::{Sequence, key};
use mapless_world::{Object, Objects, RobotConfig, SensorConfig};
use std::f64::consts::TAU;
use std::fmt;
use std::str::FromStr;

/// Distance between start and goal, metres.
const APART_M: [f64; 2] = [35.0, 75.0];
/// Start and goal stay this far inside the terrain, metres.
const BORDER_M: f64 = 5.0;
/// The least distance asked for is at most this share of the terrain's side.
const MOST_SHARE: f64 = 0.95;
/// Nobody walks off this near to the start, metres.
const ALONE_M: f64 = 2.0;
/// Pairs of start and goal tried before the terrain is given up.
const PLACES: u32 = 1000;
/// Terrains tried before a task is given up.
const MOST_DRAWN: u32 = 100;

/// The name of a task: `hard-1-0007` is task 7 of seed 1.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct TaskName {
    /// What its terrain is like.
    pub family: Family,
    /// Seed of all tasks of a kind.
    pub seed: u64,
    /// Its number, from 1 to [`MOST`](Self::MOST).
    pub index: u32,
}

/// No task has such a name.
#[derive(Clone, Debug, Eq, PartialEq, thiserror::Error)]
#[error("{text:?}: expected the name of a generated task, such as \"hard-1-0007\"")]
pub struct NoTaskName {
    text: String,
}

impl TaskName {
    /// The largest number of a task: names have four digits for it.
    pub const MOST: u32 = 9999;

    /// Whether belly, bumpers and steps count: where there are obstacles, ditches among them.
    fn touches_ground(self) -> bool {
        !matches!(self.family, Family::Ground(_))
    }

    /// What the oracle knows of the task's terrain.
    fn world(self, terrain: &Terrain) -> KnownWorld {
        let objects = Objects::new(terrain.objects.clone(), &terrain.field);
        let (robot, sensor) = (RobotConfig::default(), SensorConfig::default());
        KnownWorld::of(&terrain.field, &objects, &robot, &sensor, self.touches_ground())
    }
}

impl fmt::Display for TaskName {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}-{}-{:04}", self.family, self.seed, self.index)
    }
}

impl FromStr for TaskName {
    type Err = NoTaskName;

    fn from_str(text: &str) -> Result<Self, NoTaskName> {
        let read = || {
            let mut parts = text.splitn(3, '-');
            let family = parts.next()?.parse().ok()?;
            let seed = parts.next()?.parse().ok()?;
            Some(Self { family, seed, index: parts.next()?.parse().ok()? })
        };
        // Every task has one name: a plus sign or further zeros are refused.
        let named = read().filter(|name| (1..=Self::MOST).contains(&name.index) && name.to_string() == text);
        named.ok_or_else(|| NoTaskName { text: text.to_owned() })
    }
}

/// A task that the oracle has solved.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// Its name.
    pub name: TaskName,
    /// Its recipe, as text.
    pub recipe: String,
    /// The terrain of the recipe.
    pub terrain: Terrain,
    /// Where the robot starts.
    pub start: PlanPose,
    /// The goal, metres.
    pub goal_m: DVec2,
    /// Seed of the sensor's noise: the number of the task.
    pub seed: u32,
    /// The oracle's path.
    pub path: OraclePath,
    /// Whether driving straight from start to goal is safe too.
    pub straight_is_safe: bool,
    /// Terrains drawn until the oracle solved one, this one included.
    pub drawn: u32,
}

/// Why there is no task.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TaskError {
    /// The oracle solved none of those drawn.
    #[error("{name}: none of {MOST_DRAWN} tasks drawn has a safe path")]
    Unsolved {
        /// Which task.
        name: TaskName,
    },
    /// A generated recipe that makes no terrain.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// A robot or oracle configuration outside its range.
    #[error(transparent)]
    Oracle(#[from] OracleError),
}

impl Task {
    /// The task of a name, for a Husky.
    ///
    /// # Errors
    /// [`TaskError::Unsolved`] when a hundred draws bring none with a safe path.
    pub fn generate(name: TaskName) -> Result<Self, TaskError> {
        let TaskName { family, seed, index } = name;
        let config = OracleConfig::default();
        for drawn in 1..=MOST_DRAWN {
            let place = key(key(seed, family.index()), u64::from(index));
            let terrain_seed = key(place, u64::from(drawn));
            let recipe = terrain_recipe(&name.to_string(), family, terrain_seed);
            let no_import =
                &mut |_: &str, _: &_| Err(Fault::Read { reason: "expected no import".to_owned() });
            let terrain = load_recipe(&format!("{name}.toml"), recipe.as_bytes(), no_import)?;
            let world = name.world(&terrain);
            let safe_poses = SafePoses::new(&world, &config)?;
            let mut draw = Sequence::new(key(terrain_seed, 1));
            let Some((start, goal_m)) = start_and_goal(&safe_poses, &mut draw) else { continue };
            let sets_out_at_start = |object: &Object| {
                object.walk().is_some() && object.place_m().distance(start.position_m) < ALONE_M
            };
            if terrain.objects.iter().any(sets_out_at_start) {
                continue;
            }
            let Ok(path) = safe_poses.search(start, goal_m, config.cell_m) else { continue };
            let straight_is_safe = safe_poses.straight_is_safe(start.position_m, goal_m);
            return Ok(Self {
                name,
                recipe,
                terrain,
                start,
                goal_m,
                seed: index,
                path,
                straight_is_safe,
                drawn,
            });
        }
        Err(TaskError::Unsolved { name })
    }

    /// Straight distance from start to goal, metres.
    #[must_use]
    pub fn straight_m(&self) -> f64 {
        self.start.position_m.distance(self.goal_m)
    }

    /// The task as a scenario file whose terrain is at `terrain`, a path relative to it.
    #[must_use]
    pub fn scenario(&self, terrain: &str) -> String {
        let (PlanPose { position_m: start, yaw_rad }, goal) = (self.start, self.goal_m);
        let reality =
            if self.name.touches_ground() { "\n[reality.motion]\ntouches_ground = true\n" } else { "" };
        format!(
            "# Generated. The oracle's path is {:.1} m long, the straight way {:.1} m.\n\
             terrain = {terrain:?}\n\
             start = [{:.2}, {:.2}, {yaw_rad:.3}]\n\
             goal = [{:.2}, {:.2}]\n\
             seed = {}\n{reality}",
            self.path.length_m,
            self.straight_m(),
            start.x,
            start.y,
            goal.x,
            goal.y,
            self.seed
        )
    }
}

/// Draws start and goal, rounded as a scenario file has them: two decimals of a metre, three of a radian.
fn start_and_goal(safe_poses: &SafePoses, draw: &mut Sequence) -> Option<(PlanPose, DVec2)> {
    let inside_m = safe_poses.extent_m() - DVec2::splat(2.0 * BORDER_M);
    let place = |draw: &mut Sequence| {
        let position_m = DVec2::splat(BORDER_M) + inside_m * DVec2::new(draw.share(), draw.share());
        (position_m * 100.0).round() / 100.0
    };
    // Pairs drawn evenly are mostly near each other.
    let least_m = draw.between([APART_M[0], MOST_SHARE * safe_poses.extent_m().min_element()]);
    let apart_m = least_m.min(APART_M[1])..=APART_M[1];
    let (start_m, goal_m) = (0..PLACES).find_map(|_| {
        let (start_m, goal_m) = (place(draw), place(draw));
        let fits = apart_m.contains(&start_m.distance(goal_m));
        let safe = || [start_m, goal_m].into_iter().all(|at_m| safe_poses.every_heading_is_safe(at_m));
        (fits && safe()).then_some((start_m, goal_m))
    })?;
    let path = goal_m - start_m;
    let heading_rad = if draw.happens(0.5) {
        libm::atan2(path.y, path.x) + draw.between([-0.3, 0.3])
    } else {
        draw.between([-TAU / 2.0, TAU / 2.0])
    };
    let yaw_rad = (heading_rad * 1000.0).round() / 1000.0;
    Some((PlanPose { position_m: start_m, yaw_rad }, goal_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shortest_path;
    use mapless_terrain::generate::Difficulty;
    use proptest::prelude::*;
    use rayon::prelude::{IntoParallelRefIterator as _, ParallelIterator as _};

    proptest! {
        #[test]
        fn a_task_has_one_name(kind in 0..Family::ALL.len(), seed: u64, index in 1..=TaskName::MOST) {
            let name = TaskName { family: Family::ALL[kind], seed, index };
            prop_assert_eq!(name.to_string().parse(), Ok(name));
        }
    }

    #[test]
    fn what_names_no_task_is_refused_with_an_example() {
        for text in [
            "",
            "hard-1",
            "hard-1-7",
            "hard-01-0007",
            "hard-+1-0007",
            "hard-1-0000",
            "hard-1-10000",
            "odd-1-0001",
            "hard-1-0007-",
        ] {
            let error = text.parse::<TaskName>().unwrap_err().to_string();
            assert_eq!(
                error,
                format!("{text:?}: expected the name of a generated task, such as \"hard-1-0007\"")
            );
        }
    }

    #[test]
    fn a_task_is_the_same_twice_and_its_path_is_safe() {
        Family::ALL.par_iter().for_each(|&family| {
            let name = TaskName { family, seed: 3, index: 2 };
            let task = Task::generate(name).unwrap();
            assert!((APART_M[0]..=APART_M[1]).contains(&task.straight_m()));
            let world = name.world(&task.terrain);
            let path = shortest_path(&world, task.start, task.goal_m, &OracleConfig::default());
            assert_eq!(path.as_ref(), Ok(&task.path));
            // Generating takes long, and every family draws with the same generator: two stand for all.
            if [Family::Ground(Difficulty::Hard), Family::Mixed].contains(&family) {
                assert_eq!(task, Task::generate(name).unwrap());
            }
        });
    }

    #[test]
    fn a_scenario_has_the_task_s_numbers() {
        let task = Task::generate("easy-1-0001".parse().unwrap()).unwrap();
        assert_ne!(task.recipe, Task::generate("easy-1-0002".parse().unwrap()).unwrap().recipe);
        let text = task.scenario("terrain/a.toml");
        let numbers = |key: &str| -> Vec<f64> {
            let line = text.lines().find_map(|line| line.strip_prefix(key)).unwrap();
            let list = line.trim_matches(|c: char| " =[]".contains(c));
            list.split(", ").map(|number| number.parse().unwrap()).collect()
        };
        let PlanPose { position_m, yaw_rad } = task.start;
        assert_eq!(numbers("start"), [position_m.x, position_m.y, yaw_rad]);
        assert_eq!(numbers("goal"), task.goal_m.to_array());
        assert!(text.contains("terrain = \"terrain/a.toml\"\n") && text.ends_with("seed = 1\n"), "{text}");
    }
}
