//! Import of [Verti-Bench](https://github.com/RobotiXX/verti_bench) (RSS 2025, arXiv 2502.11426): worlds of
//! steep ground with rocks and trees, each with several pairs of start and goal.
//!
//! The benchmark's heights are images of 8 bits with one pixel a metre. Their levels are kept, in PNG images
//! of 8 bits, and a recipe gives them their range. Nothing is smoothed: the benchmark's own simulator spans
//! triangles between the pixels, this one bilinear patches through the same points. So a step between two
//! levels is a slope of one cell: 1.1° where the highest ground is 4.8 m, 3.6° where it is 16 m, at any
//! scale.
//!
//! Rocks and trees are boxes, as the benchmark's collision shapes are. They stand on the ground; the
//! benchmark's own heights of them do not fit its ground.

mod bmp;
mod checks;
mod source;
#[cfg(test)]
mod testing;

use std::fmt::{self, Write as _};
use std::fs;
use std::path::{Path, PathBuf};

use crate::error::CampaignError;
use crate::files::write_atomically;
use bmp::GreyImage;
use source::World;

/// The robot has reached a goal within this distance at full scale, metres.
const GOAL_TOLERANCE_M: f64 = 8.0;
/// Length, width and height of a rock of scale 1, and of a tree, metres.
const ROCK_M: [f64; 3] = [4.4, 4.4, 3.8];
const TREE_M: [f64; 3] = [1.0, 1.0, 5.0];
/// Spacing of the pixels at full scale, metres.
const PIXEL_M: f64 = 1.0;

/// How steep and how dense a world is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Difficulty {
    /// Up to 4.8 m high.
    Low,
    /// Up to 9.6 m high.
    Mid,
    /// Up to 16 m high.
    High,
}

impl Difficulty {
    /// All of them, the easiest first.
    pub(crate) const ALL: [Self; 3] = [Self::Low, Self::Mid, Self::High];

    /// The name, with which the names of routes begin.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Mid => "mid",
            Self::High => "high",
        }
    }
}

/// Scales at which the pixels' spacing is one of a terrain.
const SCALES: std::ops::RangeInclusive<f64> = 0.01..=100.0;

/// A factor for all lengths: `1/5`, `0.2`, `1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(f64);

impl std::str::FromStr for Scale {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<f64>().ok();
        let factor = match text.split_once('/') {
            Some((above, below)) => number(above).zip(number(below)).map(|(above, below)| above / below),
            None => number(text),
        };
        let factor = factor.filter(|factor| SCALES.contains(factor));
        factor.map(Self).ok_or_else(|| format!("{text:?}: expected 0.01 to 100, such as 1/5 or 0.2"))
    }
}

impl fmt::Display for Scale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// What an import has written.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Worlds.
    pub worlds: usize,
    /// Pairs of start and goal.
    pub tasks: usize,
    /// The campaign that drives them all.
    pub campaign: PathBuf,
    /// What is odd about worlds and tasks.
    pub warnings: Vec<String>,
}

/// Reads the benchmark in `folder` and writes it to `out` with all lengths times `scale`: heights and recipes
/// of the worlds, a scenario for each pair of start and goal, and a campaign.
///
/// # Errors
/// [`CampaignError`] names the file, the place, the value and what was expected. A file that is there with
/// other contents is an error, and is left as it is.
pub fn import(folder: &Path, scale: Scale, out: &Path) -> Result<Imported, CampaignError> {
    let worlds = source::read(folder)?;
    let (worlds, yielding): (Vec<World>, Vec<World>) = worlds.into_iter().partition(|world| world.is_rigid);
    let mut warnings = Vec::new();
    if !yielding.is_empty() {
        let count = yielding.len();
        warnings.push(format!("worlds left out: {count}, whose ground gives; the simulated ground does not"));
    }
    let scaled = worlds.iter().map(|world| ScaledWorld::read(world, scale));
    // Whatever is wrong with an image is known before anything is written.
    for world in scaled.collect::<Result<Vec<_>, CampaignError>>()? {
        world.write(out)?;
        warnings.extend(checks::of_world(world.world, out)?);
    }
    let campaign = out.join("verti-bench.toml");
    keep(&campaign, campaign_text(scale).as_bytes())?;
    Ok(Imported {
        worlds: worlds.len(),
        tasks: worlds.iter().map(|world| world.pairs.len()).sum(),
        campaign,
        warnings,
    })
}

fn campaign_text(scale: Scale) -> String {
    format!(
        "# Verti-Bench times {scale}. `tasks/*-02.toml` in place of `tasks/*.toml` is one task of each world.\n\
         benchmark = \"verti_bench\"\n\
         planners = [\"default\", \"oracle\", \"vgf_tuned\", \"putn\"]\n\
         routes = [\"tasks/*.toml\"]\n\
         seeds = [1]\n"
    )
}

/// A world with its heights, and the factor for its lengths.
struct ScaledWorld<'a> {
    world: &'a World,
    image: GreyImage,
    scale: Scale,
}

impl<'a> ScaledWorld<'a> {
    fn read(world: &'a World, scale: Scale) -> Result<Self, CampaignError> {
        let bytes = fs::read(&world.image).map_err(|error| CampaignError::read(&world.image, error))?;
        let image = bmp::read(&bytes).map_err(|reason| CampaignError::content(&world.image, reason))?;
        Ok(Self { world, image, scale })
    }

    fn write(&self, out: &Path) -> Result<(), CampaignError> {
        let number = self.world.number;
        let heights = out.join(format!("worlds/{number:03}.png"));
        let png = self.png().map_err(|error| CampaignError::write(&heights, error))?;
        keep(&heights, &png)?;
        keep(&recipe_file(self.world, out), self.recipe()?.as_bytes())?;
        for pair in 0..self.world.pairs.len() {
            keep(&scenario_file(self.world, pair, out), self.scenario(pair).as_bytes())?;
        }
        Ok(())
    }

    fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.image.columns as u32, self.image.rows as u32);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&self.image.levels)?;
        Ok(bytes)
    }

    /// A place from the south-west corner.
    fn place_m(&self, [east_m, north_m]: [f64; 2]) -> [f64; 2] {
        let GreyImage { columns, rows, .. } = self.image;
        let middle_m = |pixels: usize| (pixels - 1) as f64 / 2.0 * PIXEL_M;
        [self.scaled_m(middle_m(columns) + east_m), self.scaled_m(middle_m(rows) + north_m)]
    }

    /// A length times the scale, to a tenth of a millimetre.
    fn scaled_m(&self, length_m: f64) -> f64 {
        (self.scale.0 * length_m * 1e4).round() / 1e4
    }

    fn recipe(&self) -> Result<String, CampaignError> {
        let World { number, max_height_m, .. } = self.world;
        let difficulty = self.world.difficulty.name();
        let mut text = format!(
            "name = \"Verti-Bench {number}\"\n\
             description = \"World {number} of Verti-Bench, {difficulty}, times {}\"\n\n\
             [import]\nfile = \"{number:03}.png\"\ncell_m = {:?}\nheight_min_m = 0.0\nheight_max_m = {:?}\n",
            self.scale,
            self.scale.0 * PIXEL_M,
            self.scale.0 * max_height_m,
        );
        for (kind, obstacles, size_m) in
            [("rocks", &self.world.rocks, ROCK_M), ("trees", &self.world.trees, TREE_M)]
        {
            for (index, &[east_m, north_m, scale]) in obstacles.iter().enumerate() {
                let place = format!("{kind}[{}]", index + 1);
                let at = self.on_map(&place, [east_m, north_m])?;
                let size_m = size_m.map(|side_m| self.scaled_m(scale * side_m));
                // Writing to a string cannot fail.
                let _ = write!(text, "\n[[objects]]\nkind = \"box\"\nat = {at:?}\nsize_m = {size_m:?}\n");
            }
        }
        Ok(text)
    }

    /// A place from the south-west corner, which must be on the map.
    fn on_map(&self, place: &str, from_middle_m: [f64; 2]) -> Result<[f64; 2], CampaignError> {
        let reach_m = [self.image.columns, self.image.rows].map(|pixels| (pixels - 1) as f64 / 2.0 * PIXEL_M);
        if from_middle_m.into_iter().zip(reach_m).all(|(at_m, reach_m)| at_m.abs() <= reach_m) {
            return Ok(self.place_m(from_middle_m));
        }
        let number = self.world.number;
        let reason = format!(
            "world {number}, {place} at {from_middle_m:?}: expected a place on the map, at most {reach_m:?} m \
             from its middle"
        );
        Err(CampaignError::content(&self.world.file, reason))
    }

    fn scenario(&self, pair: usize) -> String {
        let World { number, pairs, .. } = self.world;
        let [start, goal] = pairs[pair].map(|place| self.place_m(place));
        let heading_rad = libm::atan2(goal[1] - start[1], goal[0] - start[0]);
        format!(
            "# Verti-Bench, world {number}, pair {} of {}, times {}.\n\
             terrain = \"../worlds/{number:03}.toml\"\n\
             start = [{:?}, {:?}, {heading_rad:.4}]\n\
             goal = {goal:?}\n\
             seed = 1\n\n\
             [planner]\ngoal_tolerance_m = {:?}\n",
            pair + 1,
            pairs.len(),
            self.scale,
            start[0],
            start[1],
            self.scaled_m(GOAL_TOLERANCE_M),
        )
    }
}

fn recipe_file(world: &World, out: &Path) -> PathBuf {
    out.join(format!("worlds/{:03}.toml", world.number))
}

/// The scenario of a pair, counted from 0.
fn scenario_file(world: &World, pair: usize, out: &Path) -> PathBuf {
    out.join(format!("tasks/{}-{:03}-{:02}.toml", world.difficulty.name(), world.number, pair + 1))
}

/// Writes a file, unless it is there already with these contents; other contents are an error.
fn keep(path: &Path, bytes: &[u8]) -> Result<(), CampaignError> {
    match fs::read(path) {
        Ok(found) if found == bytes => Ok(()),
        Ok(_) => {
            Err(CampaignError::write(path, "it has other contents: expected no file, or the imported one"))
        }
        Err(_) => {
            let folder = path.parent().unwrap_or(Path::new("."));
            fs::create_dir_all(folder).map_err(|error| CampaignError::write(folder, error))?;
            write_atomically(path, bytes)
        }
    }
}

#[cfg(test)]
mod tests;
