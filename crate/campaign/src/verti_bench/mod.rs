//! Import of [Verti-Bench](https://github.com/RobotiXX/verti_bench): the worlds of a folder
//! ([`mapless_verti_bench`]) as files of terrains and scenarios, and a campaign of all of them.

mod checks;
mod source;
#[cfg(test)]
mod testing;

use std::fs;
use std::path::{Path, PathBuf};

pub(crate) use mapless_verti_bench::Difficulty;
pub use mapless_verti_bench::Scale;
use mapless_verti_bench::{GreyImage, ScaledWorld, World};

use crate::error::CampaignError;
use crate::files::write_atomically;
use source::Source;

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
    let (worlds, yielding): (Vec<Source>, Vec<Source>) =
        source::read(folder)?.into_iter().partition(|source| source.world.is_rigid);
    let mut warnings = Vec::new();
    if !yielding.is_empty() {
        let count = yielding.len();
        warnings.push(format!("worlds left out: {count}, whose ground gives; the simulated ground does not"));
    }
    let heights = worlds.iter().map(read_heights);
    // Whatever is wrong with an image is known before anything is written.
    let heights = heights.collect::<Result<Vec<_>, CampaignError>>()?;
    for (source, heights) in worlds.iter().zip(&heights) {
        write(source, ScaledWorld { world: &source.world, heights, scale }, out)?;
        warnings.extend(checks::of_world(source, out)?);
    }
    let campaign = out.join("verti-bench.toml");
    keep(&campaign, campaign_text(scale).as_bytes())?;
    Ok(Imported {
        worlds: worlds.len(),
        tasks: worlds.iter().map(|source| source.world.pairs.len()).sum(),
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

fn read_heights(Source { image, .. }: &Source) -> Result<GreyImage, CampaignError> {
    let bytes = fs::read(image).map_err(|error| CampaignError::read(image, error))?;
    GreyImage::from_bmp(&bytes).map_err(|fault| CampaignError::content(image, fault))
}

fn write(source: &Source, scaled: ScaledWorld<'_>, out: &Path) -> Result<(), CampaignError> {
    let heights = out.join("worlds").join(source.world.heights_name());
    let png = scaled.heights_png().map_err(|fault| CampaignError::write(&heights, fault))?;
    keep(&heights, &png)?;
    let at_fault = |fault| CampaignError::content(&source.file, fault);
    keep(&recipe_file(&source.world, out), scaled.recipe().map_err(at_fault)?.as_bytes())?;
    for pair in 0..source.world.pairs.len() {
        let scenario = scaled.scenario(pair).map_err(at_fault)?;
        keep(&scenario_file(&source.world, pair, out), scenario.as_bytes())?;
    }
    Ok(())
}

fn recipe_file(world: &World, out: &Path) -> PathBuf {
    out.join("worlds").join(world.recipe_name())
}

/// The scenario of a pair, counted from 0.
fn scenario_file(world: &World, pair: usize, out: &Path) -> PathBuf {
    out.join("tasks").join(world.scenario_name(pair))
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
