//! Atomic writes of files, and tidy paths.

use std::fs;
use std::io::Write as _;
use std::path::{Component, Path, PathBuf};

use crate::error::CampaignError;

/// Prefix of unfinished files.
const PART: &str = ".part-";

/// Removes the unfinished files of killed processes in `folder`, if that exists. No other process may be
/// writing there.
pub(crate) fn remove_unfinished(folder: &Path) -> Result<(), CampaignError> {
    let Ok(files) = fs::read_dir(folder) else { return Ok(()) };
    for file in files {
        let path = file.map_err(|error| CampaignError::read(folder, error))?.path();
        if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PART)) {
            fs::remove_file(&path).map_err(|error| CampaignError::write(&path, error))?;
        }
    }
    Ok(())
}

/// Writes `bytes` to `path` atomically: a reader sees the old file or the new one, also after a power
/// failure.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), CampaignError> {
    let fail = |error: std::io::Error| CampaignError::write(path, error);
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut file = tempfile::Builder::new().prefix(PART).tempfile_in(folder).map_err(fail)?;
    file.write_all(bytes).map_err(fail)?;
    file.as_file().sync_all().map_err(fail)?;
    // Temporary files are readable by their owner alone; results are readable as the folder's permissions
    // say.
    let written = file.into_temp_path().keep().map_err(|error| fail(error.error))?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        fs::set_permissions(&written, fs::Permissions::from_mode(0o644)).map_err(fail)?;
    }
    fs::rename(&written, path).map_err(fail)
}

/// The path without `.` and without `folder/..`, as far as that needs no access to the disk.
pub(crate) fn tidy(path: &Path) -> PathBuf {
    let mut tidy = PathBuf::new();
    for part in path.components() {
        let has_folder = matches!(tidy.components().next_back(), Some(Component::Normal(_)));
        match part {
            Component::CurDir => {}
            Component::ParentDir if has_folder => {
                tidy.pop();
            }
            _ => tidy.push(part),
        }
    }
    tidy
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_lose_their_detours() {
        for (path, expected) in [
            ("a/b/../c.toml", "a/c.toml"),
            ("./a/./b", "a/b"),
            ("../a", "../a"),
            ("a/../../b", "../b"),
            ("/a/../b", "/b"),
        ] {
            assert_eq!(tidy(Path::new(path)), Path::new(expected), "{path}");
        }
    }

    #[test]
    fn a_file_is_replaced_whole_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        write_atomically(&path, b"first, and longer").unwrap();
        write_atomically(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        fs::write(folder.path().join(".part-killed"), "fir").unwrap();
        remove_unfinished(folder.path()).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        remove_unfinished(&folder.path().join("none")).unwrap();
        let error = write_atomically(&folder.path().join("none/a.csv"), b"").unwrap_err().to_string();
        assert!(error.contains("a.csv: cannot be written"), "{error}");
    }
}
