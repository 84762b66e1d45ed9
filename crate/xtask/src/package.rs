//! Debian packages of `mapless-node`: static programs, built without a C toolchain.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use clap::ValueEnum;
use xshell::{Shell, cmd};

use crate::{notices, setup, static_programs};

const SOURCES: &str = "crate/node";
/// What dpkg runs.
const SCRIPTS: [&str; 3] = ["postinst", "prerm", "postrm"];

/// A ROS 2 distribution that the node is built for.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Distro {
    /// Humble Hawksbill.
    Humble,
    /// Jazzy Jalisco.
    Jazzy,
}

/// A processor, by Debian's name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Arch {
    /// x86-64.
    Amd64,
    /// AArch64.
    Arm64,
}

impl Distro {
    const fn name(self) -> &'static str {
        match self {
            Self::Humble => "humble",
            Self::Jazzy => "jazzy",
        }
    }
}

impl Arch {
    const fn name(self) -> &'static str {
        match self {
            Self::Amd64 => "amd64",
            Self::Arm64 => "arm64",
        }
    }

    /// Its number in the header of an ELF file.
    const fn elf_machine(self) -> u8 {
        match self {
            Self::Amd64 => 62,
            Self::Arm64 => 183,
        }
    }

    const fn target(self) -> &'static str {
        match self {
            Self::Amd64 => static_programs::X86_64,
            Self::Arm64 => static_programs::AARCH64,
        }
    }
}

/// Builds the package, installs and removes it in an empty system, and says where it is.
pub(crate) fn run(sh: &Shell, distro: Distro, arch: Arch) -> anyhow::Result<()> {
    ensure!(
        cmd!(sh, "dpkg-deb --version").quiet().ignore_stdout().ignore_stderr().run().is_ok(),
        "dpkg-deb, which makes Debian packages, is not on PATH: install dpkg"
    );
    let package = build(sh, distro, arch)?;
    try_out(sh, distro, arch, &package)?;
    println!("{}", package.display());
    Ok(())
}

fn build(sh: &Shell, distro: Distro, arch: Arch) -> anyhow::Result<PathBuf> {
    let (distro, target) = (distro.name(), arch.target());
    setup::target(sh, target)?;
    let build =
        cmd!(sh, "cargo build --release --package mapless-node --no-default-features --features {distro}");
    static_programs::linked(build, target).run()?;
    let program = setup::target_dir(sh).join(target).join("release/mapless-node");

    let version = env!("CARGO_PKG_VERSION");
    let name = format!("mapless-node-{distro}_{version}_{}", arch.name());
    let folder = setup::target_dir(sh).join("package");
    let root = folder.join(&name);
    sh.remove_path(&root)?;
    let put = |from: &Path, to: &str| -> anyhow::Result<()> {
        let to = root.join(to);
        sh.create_dir(to.parent().context("a file in the package's root")?)?;
        Ok(sh.copy_file(from, to)?)
    };
    let source = |path: &str| Path::new(SOURCES).join(path);
    put(&program, "usr/bin/mapless-node")?;
    put(&source(&format!("config/husky-{distro}.yaml")), "etc/mapless/robot.yaml")?;
    put(&source("package/mapless-node.service"), "usr/lib/systemd/system/mapless-node.service")?;
    put(Path::new("docs/ROBOT.md"), "usr/share/doc/mapless-node/ROBOT.md")?;
    put(Path::new("LICENSE-MIT"), "usr/share/doc/mapless-node/copyright")?;
    put(&source("foxglove/mapless.json"), "usr/share/doc/mapless-node/foxglove.json")?;
    let notices = notices::of(sh, "mapless-node", target, distro)?;
    sh.write_file(root.join("usr/share/doc/mapless-node/LICENSES-of-linked-crates.txt"), notices)?;
    sh.write_file(root.join("DEBIAN/control"), control(distro, version, arch))?;
    sh.write_file(root.join("DEBIAN/conffiles"), "/etc/mapless/robot.yaml\n")?;
    for script in SCRIPTS {
        put(&source(&format!("package/{script}")), &format!("DEBIAN/{script}"))?;
        let script = root.join("DEBIAN").join(script);
        cmd!(sh, "chmod 755 {script}").quiet().run()?;
    }
    let package = folder.join(format!("{name}.deb"));
    cmd!(sh, "dpkg-deb --root-owner-group --build {root} {package}").ignore_stdout().run()?;
    Ok(package)
}

/// Installs it twice, has the program check its configuration, removes and purges it, with dpkg, in a system
/// of its own that has nothing else; what is edited outlasts all but the purge.
fn try_out(sh: &Shell, distro: Distro, arch: Arch, package: &Path) -> anyhow::Result<()> {
    let root = setup::target_dir(sh).join("package/root");
    sh.remove_path(&root)?;
    for folder in ["info", "updates", "triggers"] {
        sh.create_dir(root.join("var/lib/dpkg").join(folder))?;
    }
    for file in ["status", "available"] {
        sh.write_file(root.join("var/lib/dpkg").join(file), "")?;
    }
    let dpkg = |words: &[&str]| {
        // Neither the processor nor the user need be the robot's.
        let forced = "--force-script-chrootless,not-root,architecture,confold";
        cmd!(sh, "dpkg --root={root} --log=/dev/null {forced} {words...}").quiet().ignore_stdout().run()
    };
    let name = format!("mapless-node-{}", distro.name());
    let archive = package.display().to_string();
    let (program, unit) = ("usr/bin/mapless-node", "usr/lib/systemd/system/mapless-node.service");
    let config = root.join("etc/mapless/robot.yaml");
    let has = |path: &str| sh.path_exists(root.join(path));

    dpkg(&["--install", &archive])?;
    let machine = sh.read_binary_file(root.join(program))?.get(18).copied();
    ensure!(machine == Some(arch.elf_machine()), "{program}: its ELF header names machine {machine:?}");
    let installed = std::path::absolute(root.join(program))?;
    if cmd!(sh, "systemd-analyze --version").quiet().ignore_stdout().ignore_stderr().run().is_ok() {
        // Beside this system's own units, with the program where it lies here.
        let place = installed.display().to_string();
        let copy = root.join("mapless-node.service");
        let text = sh.read_file(root.join(unit))?;
        sh.write_file(&copy, text.replace("/usr/bin/mapless-node", &place))?;
        // Its exit code overlooks keys that it does not know.
        let told = cmd!(sh, "systemd-analyze verify {copy}").quiet().ignore_status().output()?;
        ensure!(told.stderr.is_empty(), "systemd-analyze: {}", String::from_utf8_lossy(&told.stderr));
    }
    match static_programs::command(sh, arch.target(), &installed) {
        Ok(checked) => checked.arg("--check").arg(&config).run()?,
        Err(why) => println!("The program was not run: {why:#}"),
    }
    let edited = format!("{}# edited\n", sh.read_file(&config)?);
    sh.write_file(&config, &edited)?;
    dpkg(&["--install", &archive])?;
    ensure!(sh.read_file(&config)? == edited, "an upgrade lost what was edited in robot.yaml");
    dpkg(&["--remove", &name])?;
    ensure!(!has(program) && !has(unit), "a removal left files behind");
    ensure!(sh.read_file(&config)? == edited, "a removal lost robot.yaml");
    dpkg(&["--purge", &name])?;
    ensure!(!has("etc/mapless"), "a purge left /etc/mapless behind");
    Ok(sh.remove_path(&root)?)
}

fn control(distro: &str, version: &str, arch: Arch) -> String {
    let other = if distro == "humble" { "jazzy" } else { "humble" };
    let arch = arch.name();
    format!(
        "Package: mapless-node-{distro}\nVersion: {version}\nArchitecture: {arch}\nSection: misc\nPriority: optional\n\
         Maintainer: mapless maintainers\nConflicts: mapless-node-{other}\n\
         Description: mapless navigation on uneven terrain as a ROS 2 node\n \
         Takes a LiDAR, odometry and an IMU and drives a robot to goals, without a map and without a ROS\n \
         installation. Built for the messages of ROS 2 {distro}.\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_packages_of_the_distributions_exclude_each_other() {
        let control = control("jazzy", "1.2.3", Arch::Arm64);
        assert!(control.starts_with("Package: mapless-node-jazzy\nVersion: 1.2.3\nArchitecture: arm64\n"));
        assert!(control.contains("\nConflicts: mapless-node-humble\n"));
        // A paragraph: each further line of the description is indented.
        let description = control.split_once("Description: ").unwrap().1;
        assert!(description.lines().skip(1).all(|line| line.starts_with(' ')));
    }
}
