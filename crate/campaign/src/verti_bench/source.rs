//! Where the worlds of Verti-Bench are: in a checkout of its repository, or a folder with `tasks.json`.

use std::fs;
use std::path::{Path, PathBuf};

use mapless_verti_bench::{World, number_of_config};

use crate::error::CampaignError;

/// A world and its files.
pub(super) struct Source {
    pub(super) world: World,
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
pub(super) fn read(folder: &Path) -> Result<Vec<Source>, CampaignError> {
    let (tasks, maps) = (folder.join("tasks.json"), folder.join(CHECKOUT));
    let mut worlds = if tasks.is_file() {
        listed(&tasks)?
    } else if maps.is_dir() {
        checked_out(&maps)?
    } else {
        let expected = format!("expected tasks.json with worlds/, or {CHECKOUT} as in the repository");
        return Err(CampaignError::read(folder, expected));
    };
    worlds.sort_by_key(|source| source.world.number);
    Ok(worlds)
}

fn listed(file: &Path) -> Result<Vec<Source>, CampaignError> {
    let text = fs::read_to_string(file).map_err(|error| CampaignError::read(file, error))?;
    let worlds = World::listed(&text).map_err(|fault| CampaignError::content(file, fault))?;
    let source = |world: World| Source {
        image: file.with_file_name("worlds").join(format!("{}.bmp", world.number)),
        file: file.to_owned(),
        world,
    };
    Ok(worlds.into_iter().map(source).collect())
}

fn checked_out(maps: &Path) -> Result<Vec<Source>, CampaignError> {
    let configs = maps.join("Configs/Final");
    let files = fs::read_dir(&configs).map_err(|error| CampaignError::read(&configs, error))?;
    let mut worlds = Vec::new();
    for file in files {
        let file = file.map_err(|error| CampaignError::read(&configs, error))?.path();
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        if number_of_config(&name).is_none() {
            continue;
        }
        let text = fs::read_to_string(&file).map_err(|error| CampaignError::read(&file, error))?;
        let world = World::from_config(&name, &text).map_err(|fault| CampaignError::content(&file, fault))?;
        let image = maps.join("Worlds").join(format!("{}.bmp", world.number));
        worlds.push(Source { world, image, file });
    }
    Ok(worlds)
}
