//! `mapless replay`: what the robot decided, decided again from a recording.

use std::fs::File;
use std::io::{BufReader, Write};
use std::path::PathBuf;
use std::time::Duration;

use anyhow::Context as _;
use glam::DVec2;
use mapless_recording::{Difference, InjectedFault, News, Options, Report, Role, TopicNames, replay};

/// Differences are shown up to this many, unless all are asked for.
const SHOWN: usize = 20;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// A recording of mapless-node, or a rosbag2 MCAP with clouds, odometry and IMU.
    file: PathBuf,
    /// A value in place of the recorded one, under the keys of the node's file; without a recorded one, in
    /// place of a Husky's with a VLP-16: supervisor.max_speed_m_s=0.5, sensor.height_m=0.7.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,
    /// A topic whose type does not tell what it is for: scan, odometry, imu, emergency_stop, reset, goal_pose
    /// or clock.
    #[arg(long = "topic", value_name = "ROLE=TOPIC", value_parser = topic)]
    topics: Vec<(Role, String)>,
    /// A goal from the begin on, for files without any, in metres of the odometry's frame.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    goal: Option<DVec2>,
    /// What goes wrong, from when on and for how long, in seconds: no_scan@1.5+0.4. What it is not names all
    /// kinds.
    #[arg(long = "fault", value_name = "KIND@BEGIN+LENGTH")]
    faults: Vec<InjectedFault>,
    /// Show every difference, not the first 20.
    #[arg(long)]
    all: bool,
}

fn topic(text: &str) -> Result<(Role, String), String> {
    let names = Role::INPUTS.map(Role::name).join(", ");
    let fail = || format!("expected ROLE=TOPIC with one of {names}, as scan=/points");
    let (name, topic) = text.split_once('=').ok_or_else(fail)?;
    let role = Role::named(name).ok_or_else(fail)?;
    Ok((role, topic.to_owned()))
}

fn place(text: &str) -> Result<DVec2, String> {
    let numbers: Vec<f64> =
        text.split(',').flat_map(str::parse).filter(|number: &f64| number.is_finite()).collect();
    match numbers[..] {
        [x, y] if text.split(',').count() == 2 => Ok(DVec2::new(x, y)),
        _ => Err("expected two numbers, as 10,-2.5".to_owned()),
    }
}

/// Replays and prints; whether every decision is the recorded one, as far as there are any.
pub(crate) fn run(args: &Args) -> anyhow::Result<bool> {
    let name = || args.file.display().to_string();
    let file = File::open(&args.file).with_context(name)?;
    let options = Options {
        topics: args.topics.iter().cloned().collect::<TopicNames>(),
        settings: args.settings.clone(),
        goal_m: args.goal,
        faults: args.faults.clone(),
    };
    let mut out = std::io::stdout().lock();
    let (mut shown, mut written) = (0, Ok(()));
    let report = replay(BufReader::new(file), &options, |news| {
        if matches!(news, News::Difference(_)) {
            shown += 1;
            if shown > SHOWN && !args.all {
                return;
            }
        }
        if written.is_ok() {
            written = writeln!(out, "{}", line(news));
        }
    })
    .with_context(name)?;
    written
        .and_then(|()| write!(out, "{}", summary(&report, shown.saturating_sub(SHOWN), args.all)))
        .context("standard output")?;
    for (what, (count, last)) in &report.complaints {
        eprintln!("warning: {}: {what}: {last} ({count} times)", name());
    }
    if report.is_cut {
        eprintln!("warning: {}: cut off; replayed up to there", name());
    }
    if report.lost > 0 {
        eprintln!(
            "warning: {}: {} entries were not recorded; decisions after them may differ",
            name(),
            report.lost
        );
    }
    Ok(report.different_ticks + report.different_answers == 0)
}

fn seconds(at: Duration) -> String {
    format!("{:9.3} s", at.as_secs_f64())
}

fn line(news: &News) -> String {
    match news {
        News::Change { at, text } => format!("{}  {text}", seconds(*at)),
        News::Difference(Difference { at, whose, fields }) => {
            let fields = fields.iter().map(|(name, then, now)| format!("{name} {then:?}, now {now:?}"));
            format!("{}  {whose} differs: {}", seconds(*at), fields.collect::<Vec<_>>().join("; "))
        }
    }
}

fn summary(report: &Report, hidden: usize, all: bool) -> String {
    let Report { ticks, answers, different_ticks, different_answers, .. } = report;
    let mut text = String::new();
    if hidden > 0 && !all {
        text += &format!("and {hidden} more differences: --all shows them\n");
    }
    let until = seconds(report.until);
    text += &format!("{}: {ticks} ticks of the supervisor, {answers} answers of the planner\n", until.trim());
    if report.has_decisions {
        text += &match different_ticks + different_answers {
            0 => "no decision differs from the recorded one\n".to_owned(),
            _ => format!(
                "{different_ticks} ticks and {different_answers} answers differ from the recorded ones\n"
            ),
        };
    }
    text += &format!("digest of all decisions: {}\n", report.digest);
    if let Some(recorded) = report.recorded_digest.as_ref().filter(|recorded| **recorded != report.digest) {
        text += &format!("digest of the recorded ones: {recorded}\n");
    }
    text
}
