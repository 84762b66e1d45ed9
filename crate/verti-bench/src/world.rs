//! What the benchmark says of a world, but for its heights.

use std::collections::BTreeMap;

use crate::fault::Fault;

/// How steep and how dense a world is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Difficulty {
    /// Up to 4.8 m high.
    Low,
    /// Up to 9.6 m high.
    Mid,
    /// Up to 16 m high.
    High,
}

impl Difficulty {
    /// All of them, the easiest first.
    pub const ALL: [Self; 3] = [Self::Low, Self::Mid, Self::High];

    /// The name, with which the names of routes begin.
    pub fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Mid => "mid",
            Self::High => "high",
        }
    }
}

/// A world as the benchmark has it: lengths in metres at full scale, x east and y north from the middle of
/// the map.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// Its number.
    pub number: u32,
    /// How steep and how dense it is.
    pub difficulty: Difficulty,
    /// Whether its ground does not give.
    pub is_rigid: bool,
    /// Height of white; black is 0.
    pub max_height_m: f64,
    /// East, north and scale.
    pub rocks: Vec<[f64; 3]>,
    /// East, north and scale.
    pub trees: Vec<[f64; 3]>,
    /// Starts and goals.
    pub pairs: Vec<[[f64; 2]; 2]>,
}

/// A world in `tasks.json`.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Listed {
    difficulty: Difficulty,
    terrain_type: String,
    max_height_m: f64,
    rocks: Vec<[f64; 3]>,
    trees: Vec<[f64; 3]>,
    pairs: Vec<[[f64; 2]; 2]>,
}

const RIGID: &str = "rigid";

/// What is needed of a world's file in the benchmark's repository.
#[derive(serde::Deserialize)]
struct Config {
    obstacles: Obstacles,
    positions: Vec<Pair>,
    terrain: Terrain,
    terrain_type: String,
}

#[derive(serde::Deserialize)]
struct Obstacles {
    rocks: Vec<Obstacle>,
    trees: Vec<Obstacle>,
}

#[derive(serde::Deserialize)]
struct Obstacle {
    position: Position,
    #[serde(default = "unscaled")]
    scale: f64,
}

fn unscaled() -> f64 {
    1.0
}

#[derive(serde::Deserialize)]
struct Position {
    x: f64,
    y: f64,
}

#[derive(serde::Deserialize)]
struct Pair {
    start: [f64; 3],
    goal: [f64; 3],
}

#[derive(serde::Deserialize)]
struct Terrain {
    difficulty: Difficulty,
    max_height: f64,
}

/// The number of the world that a file such as `config3_mid.yaml` describes; none where that is not its name.
pub fn number_of_config(file_name: &str) -> Option<u32> {
    let (number, _) = file_name.strip_prefix("config")?.strip_suffix(".yaml")?.split_once('_')?;
    number.parse().ok()
}

impl World {
    /// Reads a world's file of the benchmark's repository, `Configs/Final/config3_mid.yaml` and its like.
    ///
    /// # Errors
    /// A name without the world's number; a fault of the text, with its place, value and expectation.
    pub fn from_config(file_name: &str, text: &str) -> Result<Self, Fault> {
        let number = number_of_config(file_name);
        let number = number.ok_or_else(|| Fault("expected a name such as config3_mid.yaml".to_owned()))?;
        let config: Config = serde_saphyr::from_str(text).map_err(|error| Fault(error.to_string()))?;
        let places = |obstacles: Vec<Obstacle>| {
            let place = |Obstacle { position: Position { x, y }, scale }| [x, y, scale];
            obstacles.into_iter().map(place).collect()
        };
        let from_above = |[x, y, _]: [f64; 3]| [x, y];
        let pair = |Pair { start, goal }| [from_above(start), from_above(goal)];
        let world = Self {
            number,
            difficulty: config.terrain.difficulty,
            is_rigid: config.terrain_type == RIGID,
            max_height_m: config.terrain.max_height,
            rocks: places(config.obstacles.rocks),
            trees: places(config.obstacles.trees),
            pairs: config.positions.into_iter().map(pair).collect(),
        };
        world.checked()
    }

    /// Reads the worlds of a `tasks.json`.
    ///
    /// # Errors
    /// A fault of the text, with its place, value and expectation.
    pub fn listed(text: &str) -> Result<Vec<Self>, Fault> {
        let worlds: BTreeMap<u32, Listed> =
            serde_json::from_str(text).map_err(|error| Fault(error.to_string()))?;
        let world = |(number, world): (u32, Listed)| Self {
            number,
            difficulty: world.difficulty,
            is_rigid: world.terrain_type == RIGID,
            max_height_m: world.max_height_m,
            rocks: world.rocks,
            trees: world.trees,
            pairs: world.pairs,
        };
        worlds.into_iter().map(world).map(Self::checked).collect()
    }

    /// Name of the image of its heights, beside the recipe: `003.png`.
    pub fn heights_name(&self) -> String {
        format!("{:03}.png", self.number)
    }

    /// Name of its recipe: `003.toml`.
    pub fn recipe_name(&self) -> String {
        format!("{:03}.toml", self.number)
    }

    /// Name of the scenario of a pair, counted from 0: `mid-003-01.toml`.
    pub fn scenario_name(&self, pair: usize) -> String {
        format!("{}-{:03}-{:02}.toml", self.difficulty.name(), self.number, pair + 1)
    }

    /// Checks what no later reader of the world does.
    fn checked(self) -> Result<Self, Fault> {
        let positive = |place: String, value: f64| {
            let fault =
                || Fault(format!("world {}, {place} = {value}: expected a positive number", self.number));
            if value > 0.0 && value.is_finite() { Ok(()) } else { Err(fault()) }
        };
        positive("max_height_m".to_owned(), self.max_height_m)?;
        for (kind, obstacles) in [("rocks", &self.rocks), ("trees", &self.trees)] {
            for (index, [.., scale]) in obstacles.iter().enumerate() {
                positive(format!("scale of {kind}[{}]", index + 1), *scale)?;
            }
        }
        Ok(self)
    }
}
