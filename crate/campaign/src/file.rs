//! Campaign files.
//!
//! ```toml
//! planners = ["default", "paper"]
//! routes = ["../scenarios/*.toml"]        # scenario files, relative to this one
//! seeds = { from = 1, to = 100 }          # or a list
//! fewer_seeds = { paper = 30 }            # this planner drives with the first 30 seeds only
//! single_seed_routes = ["tasks/*.toml"]   # further routes, driven with the first seed only
//! truth = ["none", "profile"]             # ground truth in place of perception; "none" when absent
//! trajectories = true                     # keep those of the first seed; false when absent
//! combine = "one_at_a_time"               # or "grid", of the parameters
//! benchmark = "verti_bench"               # whose rules the report applies too; none when absent
//!
//! [[parameters]]
//! path = "planner.decision.steepness_weight"
//! values = [0.0, 0.5, 1.0]
//!
//! [[realities]]                           # beside the scenarios' own [reality]
//! name = "slippery"
//! reality = { motion = { friction = 0.4 } }   # laid over the scenario's own; a preset replaces all of it
//! planners = ["default"]                  # these alone; all when absent
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::{Path, PathBuf};

use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use crate::error::CampaignError;
use crate::files::tidy;
use mapless_baselines::Truth;
use mapless_trials::{RealityConfig, current_path, current_value};

use crate::navigators;
use crate::parameters::{self, Parameter, Variation};
use crate::reality::Condition;

/// A campaign, checked except for its routes' scenarios.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// Name of the file, without extension.
    pub name: String,
    /// Names of the planners, in the file's order.
    pub planners: Vec<String>,
    /// Scenario files, each once.
    pub routes: Vec<PathBuf>,
    /// Scenario files that are driven with the first seed alone.
    pub single_seed_routes: Vec<PathBuf>,
    /// Seeds of the sensor's noise, in the file's order.
    pub seeds: Vec<u64>,
    /// Planners that drive with fewer seeds than the others: how many, from the first on.
    pub fewer_seeds: BTreeMap<String, usize>,
    /// Ground truth in place of perception, one of these for each trial.
    pub truths: Vec<Truth>,
    /// Whether the first seed's trajectories are kept.
    pub trajectories: bool,
    /// How the parameters combine.
    pub combine: Combine,
    /// Whose rules the report applies too.
    pub benchmark: Option<Benchmark>,
    /// What else may go wrong than in the scenarios.
    pub realities: Vec<Condition>,
    /// The combinations of parameter values.
    pub(crate) variations: Vec<Variation>,
}

/// How the values of several parameters combine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Combine {
    /// The base configuration, and each value of each parameter alone. A value that the base has anyway is
    /// left out.
    #[default]
    OneAtATime,
    /// Every value of every parameter with every value of all others.
    Grid,
}

/// A benchmark of others with rules of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Benchmark {
    /// Verti-Bench: see [`crate::verti_bench`].
    VertiBench,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    planners: Spanned<Vec<Spanned<String>>>,
    routes: Spanned<Vec<Spanned<String>>>,
    single_seed_routes: Option<Spanned<Vec<Spanned<String>>>>,
    seeds: Spanned<Seeds>,
    #[serde(default)]
    fewer_seeds: BTreeMap<String, Spanned<usize>>,
    truth: Option<Spanned<Vec<Spanned<Truth>>>>,
    #[serde(default)]
    trajectories: bool,
    #[serde(default)]
    combine: Combine,
    benchmark: Option<Benchmark>,
    #[serde(default)]
    parameters: Vec<ParameterTable>,
    #[serde(default)]
    realities: Vec<RealityTable>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct ParameterTable {
    path: Spanned<String>,
    values: Spanned<Vec<Spanned<toml::Value>>>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct RealityTable {
    name: Spanned<String>,
    reality: Spanned<toml::Table>,
    planners: Option<Spanned<Vec<Spanned<String>>>>,
}

/// `[1, 2, 3]` or `{ from = 1, to = 100 }`, both ends included.
struct Seeds(Vec<u64>);

/// Most seeds of a campaign.
const MAX_SEEDS: u64 = 1_000_000;

impl Campaign {
    /// The seeds of a planner, in the file's order.
    #[must_use]
    pub fn seeds_of(&self, planner: &str) -> &[u64] {
        let count = self.fewer_seeds.get(planner).copied().unwrap_or(self.seeds.len());
        &self.seeds[..count]
    }

    /// Reads a campaign file and finds its routes.
    ///
    /// # Errors
    /// [`CampaignError`] names the file, the line, the value and what was expected.
    pub fn read(path: &Path) -> Result<Self, CampaignError> {
        let text = std::fs::read_to_string(path).map_err(|error| CampaignError::read(path, error))?;
        Self::parse(path, &text)
    }

    /// As [`Campaign::read`], with the file's text at hand.
    ///
    /// # Errors
    /// As [`Campaign::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, CampaignError> {
        let file: File = toml::from_str(text)
            .map_err(|error| CampaignError::content(path, error.to_string().trim_end()))?;
        let place = Place { path, text };
        for planner in place.distinct("planners", &file.planners, |name| format!("{name:?}"))? {
            if let Err(reason) = navigators::kind(planner.as_ref()) {
                return Err(place.error(planner.span().start, &format!("planners: {reason}")));
            }
        }
        if let Some(truths) = &file.truth {
            place.distinct("truth", truths, |truth| truth.name().to_owned())?;
        }
        let seeds = &file.seeds.as_ref().0;
        if seeds.is_empty() || seeds.iter().collect::<BTreeSet<_>>().len() != seeds.len() {
            return Err(place.error(file.seeds.span().start, "seeds: expected at least one, and each once"));
        }
        for (planner, count) in &file.fewer_seeds {
            let named = file.planners.as_ref().iter().any(|name| name.as_ref() == planner);
            if !named || !(1..=seeds.len()).contains(count.as_ref()) {
                let reason = format!(
                    "fewer_seeds: {planner} = {}: expected one of planners, and from 1 to {}",
                    count.as_ref(),
                    seeds.len()
                );
                return Err(place.error(count.span().start, &reason));
            }
        }
        let parameters = place.parameters(&file.parameters)?;
        let realities = place.realities(file.realities, file.planners.as_ref())?;
        // Last, for they may have to be generated first, and all else should be right by then.
        let routes = place.routes("routes", &file.routes, &[])?;
        let single_seed_routes = file.single_seed_routes.as_ref();
        let single_seed_routes = single_seed_routes
            .map(|patterns| place.routes("single_seed_routes", patterns, &routes))
            .transpose()?;
        Ok(Self {
            name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            routes,
            single_seed_routes: single_seed_routes.unwrap_or_default(),
            planners: plain(file.planners),
            seeds: file.seeds.into_inner().0,
            fewer_seeds: file
                .fewer_seeds
                .into_iter()
                .map(|(planner, count)| (planner, count.into_inner()))
                .collect(),
            truths: file.truth.map_or_else(|| vec![Truth::None], plain),
            trajectories: file.trajectories,
            combine: file.combine,
            benchmark: file.benchmark,
            realities,
            variations: match file.combine {
                Combine::OneAtATime => parameters::one_at_a_time(&parameters),
                Combine::Grid => parameters::grid(&parameters),
            },
        })
    }
}

fn plain<T>(values: Spanned<Vec<Spanned<T>>>) -> Vec<T> {
    values.into_inner().into_iter().map(Spanned::into_inner).collect()
}

/// The file and its text, for errors that name a line.
struct Place<'a> {
    path: &'a Path,
    text: &'a str,
}

impl Place<'_> {
    fn error(&self, at: usize, reason: &str) -> CampaignError {
        let line = 1 + self.text.bytes().take(at).filter(|&byte| byte == b'\n').count();
        CampaignError::content(self.path, format_args!("line {line}: {reason}"))
    }

    /// The values of a list that must not be empty nor name anything twice.
    fn distinct<'v, T>(
        &self,
        key: &str,
        values: &'v Spanned<Vec<Spanned<T>>>,
        name: impl Fn(&T) -> String,
    ) -> Result<&'v [Spanned<T>], CampaignError> {
        let mut seen = BTreeSet::new();
        for value in values.as_ref() {
            let name = name(value.as_ref());
            if !seen.insert(name.clone()) {
                return Err(self.error(
                    value.span().start,
                    &format!("{key}: {name} stands here twice: expected it once"),
                ));
            }
        }
        if seen.is_empty() {
            return Err(self.error(values.span().start, &format!("{key} = []: expected at least one")));
        }
        Ok(values.as_ref())
    }

    /// The files of all patterns, each once. A route has its file's name, so no two files may have the same.
    fn routes(
        &self,
        key: &str,
        patterns: &Spanned<Vec<Spanned<String>>>,
        others: &[PathBuf],
    ) -> Result<Vec<PathBuf>, CampaignError> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let escaped = PathBuf::from(glob::Pattern::escape(&folder.to_string_lossy()));
        let mut routes = BTreeSet::new();
        for pattern in self.distinct(key, patterns, |pattern| format!("{pattern:?}"))? {
            let fail = |reason: &str| {
                self.error(pattern.span().start, &format!("{key}: {:?}: {reason}", pattern.as_ref()))
            };
            let found = glob::glob(&escaped.join(pattern.as_ref()).to_string_lossy()).map_err(|error| {
                fail(&format!("{error}: expected a path, with * and ? where many are meant"))
            })?;
            let before = routes.len();
            for path in found {
                let path = path.map_err(|error| CampaignError::read(error.path(), error.error()))?;
                routes.insert(tidy(&path));
            }
            if routes.len() == before {
                return Err(fail("expected at least one scenario file that no pattern before names"));
            }
        }
        let mut names = BTreeSet::new();
        for route in routes.iter().chain(others) {
            let name = route.file_stem().unwrap_or_default().to_string_lossy();
            if !names.insert(name.clone()) {
                let reason = format!("{key}: two files are named {name}: expected different names");
                return Err(self.error(patterns.span().start, &reason));
            }
        }
        Ok(routes.into_iter().collect())
    }

    fn parameters(&self, tables: &[ParameterTable]) -> Result<Vec<Parameter>, CampaignError> {
        let mut parameters: Vec<Parameter> = Vec::new();
        for table in tables {
            let path = current_path(table.path.as_ref());
            if parameters.iter().any(|before| before.path == path) {
                let reason = format!("parameters: {path:?} stands here twice: expected it once");
                return Err(self.error(table.path.span().start, &reason));
            }
            let mut values = Vec::new();
            for value in table.values.as_ref() {
                let current = current_value(table.path.as_ref(), value.as_ref());
                let normalised = parameters::normalised(&path, &current);
                values.push(normalised.map_err(|reason| {
                    self.error(value.span().start, &format!("parameters: {}: {reason}", value.as_ref()))
                })?);
            }
            self.distinct("values", &table.values, ToString::to_string)?;
            parameters.push(Parameter { path, values });
        }
        Ok(parameters)
    }

    /// The conditions of a campaign of `planners`.
    fn realities(
        &self,
        tables: Vec<RealityTable>,
        planners: &[Spanned<String>],
    ) -> Result<Vec<Condition>, CampaignError> {
        let mut conditions: Vec<Condition> = Vec::new();
        for RealityTable { name, reality, planners: own } in tables {
            let fail = |at: usize, reason: &str| self.error(at, &format!("realities: {reason}"));
            // A space or a bar would part words and cells of reports.
            let is_word = |name: &str| {
                !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c))
            };
            if !is_word(name.as_ref()) || conditions.iter().any(|before| before.name == *name.as_ref()) {
                let reason = format!(
                    "name = {:?}: expected letters, digits, '_', '-' and '.', and each name once",
                    name.as_ref()
                );
                return Err(fail(name.span().start, &reason));
            }
            RealityConfig::default()
                .with_section(reality.as_ref())
                .map_err(|fault| fail(reality.span().start, &fault.to_string()))?;
            if let Some(own) = &own {
                for planner in self.distinct("planners", own, |name| format!("{name:?}"))? {
                    if !planners.iter().any(|known| known.as_ref() == planner.as_ref()) {
                        let reason =
                            format!("planners: {:?}: expected one of the campaign's", planner.as_ref());
                        return Err(fail(planner.span().start, &reason));
                    }
                }
            }
            let (name, section) = (name.into_inner(), reality.into_inner());
            conditions.push(Condition { name, section, planners: own.map(plain) });
        }
        Ok(conditions)
    }
}

impl<'de> serde::Deserialize<'de> for Seeds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SeedsVisitor).map(Seeds)
    }
}

struct SeedsVisitor;

impl<'de> Visitor<'de> for SeedsVisitor {
    type Value = Vec<u64>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of seeds or {{ from, to }}")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Self::Value, A::Error> {
        let mut seeds = Vec::new();
        while let Some(seed) = items.next_element()? {
            seeds.push(seed);
        }
        Ok(seeds)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
        let (mut from, mut to) = (None, None);
        while let Some(key) = entries.next_key::<String>()? {
            match key.as_str() {
                "from" => from = Some(entries.next_value::<u64>()?),
                "to" => to = Some(entries.next_value::<u64>()?),
                _ => return Err(A::Error::unknown_field(&key, &["from", "to"])),
            }
        }
        let from = from.ok_or_else(|| A::Error::missing_field("from"))?;
        let to = to.ok_or_else(|| A::Error::missing_field("to"))?;
        if from > to || to - from >= MAX_SEEDS {
            return Err(A::Error::custom(format_args!(
                "from = {from}, to = {to}: expected from ≤ to, and at most {MAX_SEEDS} seeds"
            )));
        }
        Ok((from..=to).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless_trials::RealityPreset;

    const GOOD: &str = "planners = [\"default\"]\nroutes = [\"*.toml\"]\nseeds = { from = 3, to = 5 }\n";

    /// A folder with two files that could be scenarios.
    fn parse(text: &str) -> Result<Campaign, String> {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.toml", "a.toml"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        std::fs::create_dir(folder.path().join("other")).unwrap();
        std::fs::write(folder.path().join("other/a.toml"), "").unwrap();
        Campaign::parse(&folder.path().join("quick.toml"), text).map_err(|error| error.to_string())
    }

    #[test]
    fn the_campaigns_of_the_repository_are_read() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../terrains/campaigns");
        for (name, routes, seeds, variations) in
            [("quick", 10, 10, 1), ("paper", 10, 10, 1), ("ablation", 10, 1, 1 + 8 * 3)]
        {
            let campaign = Campaign::read(&folder.join(name).with_extension("toml")).unwrap();
            let counts = (campaign.routes.len(), campaign.seeds.len(), campaign.variations.len());
            assert_eq!(counts, (routes, seeds, variations), "{name}");
        }
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            // Generated and imported tasks are not part of the repository; all else is checked before.
            if let Err(error) = Campaign::read(&path) {
                assert!(error.to_string().contains("expected at least one scenario file"), "{error}");
            }
        }
    }

    #[test]
    fn the_effects_of_the_campaigns_of_reality_are_those_of_the_preset_field() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../terrains/campaigns");
        for name in ["reality-effects", "reality-full"] {
            let path = folder.join(name).with_extension("toml");
            let text = std::fs::read_to_string(&path).unwrap();
            // Its routes are generated tasks, which may not be there.
            let file: File = toml::from_str(&text).unwrap();
            let place = Place { path: &path, text: &text };
            let conditions = place.realities(file.realities, file.planners.as_ref()).unwrap();
            let section = |word: &str| toml::from_str(&format!("preset = {word:?}")).unwrap();
            assert_eq!(
                conditions[..2]
                    .iter()
                    .map(|one| (one.name.as_str(), one.section.clone()))
                    .collect::<Vec<_>>(),
                [("field", section("field")), ("harsh", section("harsh"))]
            );
            let effects = conditions[2..].iter();
            let all =
                effects.fold(RealityConfig::default(), |all, one| all.with_section(&one.section).unwrap());
            let field = RealityConfig { preset: all.preset, ..RealityPreset::Field.config() };
            assert_eq!(all, field, "{name}: every value of the preset is in one of them, and no other");
        }
    }

    #[test]
    fn a_campaign_is_read() {
        let campaign = parse(GOOD).unwrap();
        assert_eq!((campaign.name.as_str(), campaign.seeds), ("quick", vec![3, 4, 5]));
        let names: Vec<_> =
            campaign.routes.iter().map(|route| route.file_name().unwrap().to_owned()).collect();
        assert_eq!(names, ["a.toml", "b.toml"]);
        assert_eq!(campaign.truths, [Truth::None]);
        assert_eq!(campaign.variations, [Variation::new()]);
        assert_eq!(parse(&GOOD.replace("{ from = 3, to = 5 }", "[9, 2]")).unwrap().seeds, [9, 2]);
    }

    #[test]
    fn old_paths_of_parameters_are_read_as_the_new_ones() {
        let old = "[[parameters]]\npath = \"planner.forecast.escape_m\"\nvalues = [1, 2]\n";
        let new = old.replace("forecast.escape_m", "state_lattice.recovery_radius_m");
        let variations = |parameters: &str| parse(&format!("{GOOD}{parameters}")).unwrap().variations;
        assert_eq!(variations(old), variations(&new));
        let error = parse(&format!("{GOOD}{old}{new}")).unwrap_err();
        assert!(
            error.contains("line 8") && error.contains("recovery_radius_m\" stands here twice"),
            "{error}"
        );
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let parameters = "[[parameters]]\npath = \"planner.decision.steepness_weight\"\nvalues = [0.5, 1]\n";
        assert_eq!(parse(&format!("{GOOD}{parameters}")).unwrap().variations.len(), 3);
        let wet = "[[realities]]\nname = \"wet\"\nreality = { motion = { friction = 0.4 } }\n";
        assert_eq!(parse(&format!("{GOOD}{wet}")).unwrap().realities.len(), 1);
        for (text, needles) in [
            (GOOD.replace("seeds", "seed"), vec!["line 3", "unknown field `seed`", "expected"]),
            (
                GOOD.replace("default", "best"),
                vec!["quick.toml: line 1: planners: planner \"best\"", "expected one of default, paper"],
            ),
            (GOOD.replace("\"default\"", "\"paper\", \"paper\""), vec!["line 1", "\"paper\"", "twice"]),
            (GOOD.replace("\"default\"", ""), vec!["line 1", "planners = []", "at least one"]),
            (GOOD.replace("*.toml", "*.tom"), vec!["line 2", "\"*.tom\"", "at least one scenario"]),
            (GOOD.replace("*.toml", "a**b"), vec!["line 2", "\"a**b\"", "expected a path"]),
            (
                GOOD.replace("\"*.toml\"", "\"*.toml\", \"other/*.toml\""),
                vec!["line 2", "two files are named a"],
            ),
            (
                format!("{GOOD}single_seed_routes = [\"other/*.toml\"]\n"),
                vec!["line 4", "single_seed_routes: two files are named a"],
            ),
            (
                format!("{GOOD}single_seed_routes = [\"none/*.toml\"]\n"),
                vec!["line 4", "single_seed_routes", "at least one scenario file"],
            ),
            (GOOD.replace("to = 5", "to = 2"), vec!["line 3", "from = 3, to = 2", "expected from ≤ to"]),
            (GOOD.replace("to = 5", "til = 5"), vec!["line 3", "`til`", "expected"]),
            (
                format!("{GOOD}fewer_seeds = {{ default = 4 }}\n"),
                vec!["line 4", "default = 4", "from 1 to 3"],
            ),
            (
                format!("{GOOD}fewer_seeds = {{ paper = 1 }}\n"),
                vec!["line 4", "paper = 1", "one of planners"],
            ),
            (GOOD.replace("{ from = 3, to = 5 }", "[1, 1]"), vec!["line 3", "each once"]),
            (
                GOOD.replace("{ from = 3, to = 5 }", "7"),
                vec!["line 3", "`7`", "a list of seeds or { from, to }"],
            ),
            (GOOD.replace("{ from = 3, to = 5 }", "[-1]"), vec!["line 3", "-1"]),
            (format!("{GOOD}truth = [\"all\"]\n"), vec!["line 4", "all", "profile"]),
            (
                format!("{GOOD}{}", parameters.replace("steepness", "k")),
                vec!["line 6", "0.5", "planner.decision.k_weight"],
            ),
            (format!("{GOOD}{}", parameters.replace("0.5", "\"x\"")), vec!["line 6", "\"x\"", "f64"]),
            (format!("{GOOD}{}", parameters.replace("[0.5, 1]", "[]")), vec!["line 6", "values = []"]),
            (format!("{GOOD}{parameters}{parameters}"), vec!["line 8", "twice"]),
            (
                format!("{GOOD}{}", parameters.replace("values", "value")),
                vec!["line 6", "unknown field `value`"],
            ),
            (
                format!("{GOOD}{}", wet.replace("wet", "wet grass")),
                vec!["line 5", "\"wet grass\"", "letters"],
            ),
            (format!("{GOOD}{wet}{wet}"), vec!["line 8", "\"wet\"", "once"]),
            (format!("{GOOD}{}", wet.replace("0.4", "-1")), vec!["line 6", "friction = -1", "expected"]),
            (format!("{GOOD}{}", wet.replace("friction", "grip")), vec!["line 6", "unknown field `grip`"]),
            (
                format!("{GOOD}{wet}planners = [\"paper\"]\n"),
                vec!["line 7", "\"paper\"", "one of the campaign's"],
            ),
            (format!("{GOOD}{wet}planners = []\n"), vec!["line 7", "at least one"]),
        ] {
            let error = parse(&text).unwrap_err();
            for needle in needles {
                assert!(error.contains(needle), "not in the message: {needle}\n{error}");
            }
        }
    }
}
