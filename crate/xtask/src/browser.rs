//! The Chromium in which the wasm and page tests run, and the driver of the same version.

use std::env;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail, ensure};
use xshell::{Shell, cmd};

const BROWSERS: &[&str] = &[
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
];
const DRIVERS: &[&str] = &["chromedriver", "chromium.chromedriver"];

/// What the version that a driver prints begins with; no browser's does.
const DRIVER: &str = "ChromeDriver";

/// The environment variables that name the browser and the driver, in place of those on PATH.
const NAMED_BY: [&str; 2] = ["CHROME", "CHROMEDRIVER"];

const HOW_TO_INSTALL: &str = "The tests need Chromium (or Google Chrome) and a chromedriver of the same version. \
    Install both, for example with `sudo apt-get install chromium chromium-driver` on Debian, or from \
    https://googlechromelabs.github.io/chrome-for-testing/. If they are not on PATH, name them in the environment \
    variables CHROME and CHROMEDRIVER.";

/// A browser and its driver, of the same major version.
pub(crate) struct Browser {
    pub(crate) chrome: PathBuf,
    pub(crate) driver: PathBuf,
}

impl Browser {
    /// Finds a browser with its driver; if there is none, installs them with apt if this process may.
    pub(crate) fn set_up(sh: &Shell) -> anyhow::Result<Self> {
        let missing = match Self::find(sh) {
            Ok(browser) => return Ok(browser),
            Err(missing) => missing,
        };
        let is_named = NAMED_BY.iter().any(|variable| env::var_os(variable).is_some());
        let Some(packages) = apt_packages(sh).filter(|_| !is_named) else {
            bail!("{missing}. {HOW_TO_INSTALL}");
        };
        // Another installation may be under way.
        let wait = "DPkg::Lock::Timeout=600";
        cmd!(sh, "apt-get -o {wait} update").run()?;
        cmd!(sh, "apt-get -o {wait} install --yes --no-install-recommends {packages...}")
            .env("DEBIAN_FRONTEND", "noninteractive")
            .run()?;
        Self::find(sh).with_context(|| format!("apt installed {packages:?}, yet {missing}. {HOW_TO_INSTALL}"))
    }

    fn find(sh: &Shell) -> anyhow::Result<Self> {
        let browsers = versions(sh, NAMED_BY[0], BROWSERS, |printed| !printed.starts_with(DRIVER))?;
        let drivers = versions(sh, NAMED_BY[1], DRIVERS, |printed| printed.starts_with(DRIVER))?;
        ensure!(!browsers.is_empty(), "No Chromium was found");
        ensure!(!drivers.is_empty(), "No chromedriver was found");
        match same_major(&browsers, &drivers) {
            Some((chrome, driver)) => Ok(Self { chrome: chrome.to_owned(), driver: driver.to_owned() }),
            None => bail!("No chromedriver fits the browser: found {browsers:?} and {drivers:?}"),
        }
    }

    /// The content of `webdriver.json`, which wasm-bindgen's test runner passes to the driver.
    pub(crate) fn webdriver_json(&self) -> String {
        let args = [
            "--headless=new",
            // The sandbox does not start as root, as in most containers.
            "--no-sandbox",
            "--disable-gpu",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--no-first-run",
            "--disable-quic",
        ];
        let binary = self.chrome.to_string_lossy();
        format!("{{\"goog:chromeOptions\": {{\"binary\": {binary:?}, \"args\": {args:?}}}}}\n")
    }
}

/// The programs found, each with its major version: the one named by `variable`, or else those of `names`.
/// `is_one` tells by the version printed whether a program is one of those sought.
fn versions(
    sh: &Shell,
    variable: &str,
    names: &[&str],
    is_one: impl Fn(&str) -> bool,
) -> anyhow::Result<Vec<(PathBuf, u32)>> {
    let printed = |path: &Path| cmd!(sh, "{path} --version").quiet().ignore_stderr().read().ok();
    if let Some(named) = env::var_os(variable).map(PathBuf::from) {
        let printed =
            printed(&named).with_context(|| format!("{variable} names {named:?}, which tells no version"))?;
        let version = major_version(&printed).filter(|_| is_one(&printed)).with_context(|| {
            format!("{variable} names {named:?}, which is something else: its version reads {printed:?}")
        })?;
        return Ok(vec![(named, version)]);
    }
    let folders = env::var_os("PATH").unwrap_or_default();
    let found = names.iter().filter_map(|name| on_path(&folders, name)).filter_map(|path| {
        let printed = printed(&path).filter(|printed| is_one(printed))?;
        Some((path, major_version(&printed)?))
    });
    Ok(found.collect())
}

/// The path of `program`: itself if absolute, or else in the first of `folders`, a PATH, that has it.
fn on_path(folders: &OsStr, program: &str) -> Option<PathBuf> {
    // Not `with_extension`, which would cut `chromium.chromedriver` to `chromium`.
    let file = format!("{program}{}", env::consts::EXE_SUFFIX);
    env::split_paths(folders).map(|folder| folder.join(&file)).find(|path| path.is_file())
}

/// The first number of the version in `Chromium 156.0.8078.79 built on ...`.
fn major_version(printed: &str) -> Option<u32> {
    printed.split_whitespace().find_map(|word| word.split_once('.')?.0.parse().ok())
}

/// The first browser for which there is a driver of the same major version, with that driver.
fn same_major<'a>(
    browsers: &'a [(PathBuf, u32)],
    drivers: &'a [(PathBuf, u32)],
) -> Option<(&'a Path, &'a Path)> {
    browsers.iter().find_map(|(chrome, chrome_major)| {
        let (driver, _) = drivers.iter().find(|(_, driver_major)| driver_major == chrome_major)?;
        Some((chrome.as_path(), driver.as_path()))
    })
}

/// The packages that hold browser and driver, if this process may install packages with apt.
fn apt_packages(sh: &Shell) -> Option<[&'static str; 2]> {
    let is_root = cmd!(sh, "id -u").quiet().ignore_stderr().read().is_ok_and(|id| id == "0");
    let release = sh.read_file("/etc/os-release").unwrap_or_default();
    match release.lines().find_map(|line| line.strip_prefix("ID=")) {
        Some("debian") if is_root => Some(["chromium", "chromium-driver"]),
        Some("ubuntu") if is_root => Some(["chromium-browser", "chromium-chromedriver"]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn major_version_is_read_from_what_browsers_and_drivers_print() {
        assert_eq!(
            major_version("Chromium 156.0.8078.79 built on Debian GNU/Linux 12 (bookworm)"),
            Some(156)
        );
        assert_eq!(major_version("Google Chrome 131.0.6778.85 "), Some(131));
        assert_eq!(
            major_version("ChromeDriver 156.0.8078.79 (a21ce95c-refs/branch-heads/8078@{#1704})"),
            Some(156)
        );
        assert_eq!(major_version("command not found."), None);
    }

    #[test]
    fn driver_of_two_words_is_not_found_in_the_browser() {
        let sh = Shell::new().expect("a shell");
        let folder = sh.create_temp_dir().expect("a folder");
        let browser = folder.path().join(format!("chromium{}", env::consts::EXE_SUFFIX));
        sh.write_file(&browser, "").expect("a file");
        let folders = folder.path().as_os_str();
        assert_eq!(on_path(folders, "chromium"), Some(browser));
        assert_eq!(on_path(folders, "chromium.chromedriver"), None);
    }

    #[test]
    fn browser_is_paired_with_the_driver_of_its_own_version() {
        let browsers = [("/usr/bin/chromium".into(), 150), ("/usr/bin/google-chrome".into(), 156)];
        let drivers = [("/opt/chromedriver".into(), 149), ("/usr/bin/chromedriver".into(), 156)];
        let pair = same_major(&browsers, &drivers);
        assert_eq!(pair, Some((Path::new("/usr/bin/google-chrome"), Path::new("/usr/bin/chromedriver"))));
        assert_eq!(same_major(&browsers[..1], &drivers), None);
    }

    #[test]
    fn webdriver_json_names_the_browser() {
        let browser = Browser { chrome: "/opt/my chrome".into(), driver: "/opt/chromedriver".into() };
        let json = browser.webdriver_json();
        assert!(json.starts_with(
            r#"{"goog:chromeOptions": {"binary": "/opt/my chrome", "args": ["--headless=new", "#
        ));
    }
}
