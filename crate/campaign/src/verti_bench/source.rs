//! The worlds of Verti-Bench, from a checkout of its repository or from a folder with `tasks.json`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::Difficulty;
use crate::error::CampaignError;

/// A world as the benchmark has it: lengths in metres at full scale, x east and y north from the middle of
/// the map.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct World {
    pub(super) number: u32,
    pub(super) difficulty: Difficulty,
    /// Whether its ground does not give.
    pub(super) is_rigid: bool,
    /// Height of white; black is 0.
    pub(super) max_height_m: f64,
    /// East, north and scale.
    pub(super) rocks: Vec<[f64; 3]>,
    pub(super) trees: Vec<[f64; 3]>,
    /// Starts and goals.
    pub(super) pairs: Vec<[[f64; 2]; 2]>,
    /// Image of the heights.
    pub(super) image: PathBuf,
    /// The file that describes it.
    pub(super) file: PathBuf,
}

/// Where a checkout has what belongs to its worlds.
const CHECKOUT: &str = "envs/data/BenchMaps/sampled_maps";

/// Reads what is known of every world, by number.
///
/// # Errors
/// [`CampaignError`] names the file, the place, the value and what was expected.
pub(super) fn read(folder: &Path) -> Result<Vec<World>, CampaignError> {
    let (tasks, maps) = (folder.join("tasks.json"), folder.join(CHECKOUT));
    let mut worlds = if tasks.is_file() {
        listed(&tasks)?
    } else if maps.is_dir() {
        checked_out(&maps)?
    } else {
        let expected = format!("expected tasks.json with worlds/, or {CHECKOUT} as in the repository");
        return Err(CampaignError::read(folder, expected));
    };
    worlds.sort_by_key(|world| world.number);
    for world in &worlds {
        world.check()?;
    }
    Ok(worlds)
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

fn listed(file: &Path) -> Result<Vec<World>, CampaignError> {
    let text = fs::read_to_string(file).map_err(|error| CampaignError::read(file, error))?;
    let worlds: BTreeMap<u32, Listed> =
        serde_json::from_str(&text).map_err(|error| CampaignError::content(file, error))?;
    let world = |(number, world): (u32, Listed)| World {
        number,
        difficulty: world.difficulty,
        is_rigid: world.terrain_type == RIGID,
        max_height_m: world.max_height_m,
        rocks: world.rocks,
        trees: world.trees,
        pairs: world.pairs,
        image: file.with_file_name("worlds").join(format!("{number}.bmp")),
        file: file.to_owned(),
    };
    Ok(worlds.into_iter().map(world).collect())
}

const RIGID: &str = "rigid";

/// What the importer needs of a world's file in a checkout.
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

fn checked_out(maps: &Path) -> Result<Vec<World>, CampaignError> {
    let configs = maps.join("Configs/Final");
    let files = fs::read_dir(&configs).map_err(|error| CampaignError::read(&configs, error))?;
    let mut worlds = Vec::new();
    for file in files {
        let file = file.map_err(|error| CampaignError::read(&configs, error))?.path();
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let number = name.strip_prefix("config").and_then(|rest| rest.strip_suffix(".yaml")?.split_once('_'));
        let Some(number) = number.and_then(|(number, _)| number.parse().ok()) else { continue };
        let text = fs::read_to_string(&file).map_err(|error| CampaignError::read(&file, error))?;
        let config: Config =
            serde_saphyr::from_str(&text).map_err(|error| CampaignError::content(&file, error))?;
        let places = |obstacles: Vec<Obstacle>| {
            let place = |Obstacle { position: Position { x, y }, scale }| [x, y, scale];
            obstacles.into_iter().map(place).collect()
        };
        let from_above = |[x, y, _]: [f64; 3]| [x, y];
        let pair = |Pair { start, goal }| [from_above(start), from_above(goal)];
        worlds.push(World {
            number,
            difficulty: config.terrain.difficulty,
            is_rigid: config.terrain_type == RIGID,
            max_height_m: config.terrain.max_height,
            rocks: places(config.obstacles.rocks),
            trees: places(config.obstacles.trees),
            pairs: config.positions.into_iter().map(pair).collect(),
            image: maps.join("Worlds").join(format!("{number}.bmp")),
            file,
        });
    }
    Ok(worlds)
}

impl World {
    /// Checks what no later reader of the imported files does.
    fn check(&self) -> Result<(), CampaignError> {
        let positive = |place: String, value: f64| {
            let fault = || {
                let reason = format!("world {}, {place} = {value}: expected a positive number", self.number);
                CampaignError::content(&self.file, reason)
            };
            if value > 0.0 && value.is_finite() { Ok(()) } else { Err(fault()) }
        };
        positive("max_height_m".to_owned(), self.max_height_m)?;
        for (kind, obstacles) in [("rocks", &self.rocks), ("trees", &self.trees)] {
            for (index, [.., scale]) in obstacles.iter().enumerate() {
                positive(format!("scale of {kind}[{}]", index + 1), *scale)?;
            }
        }
        Ok(())
    }
}
