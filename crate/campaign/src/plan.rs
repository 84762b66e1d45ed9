//! A campaign expanded into its trials.

use std::path::Path;
use std::sync::Arc;

use mapless::PlannerConfig;
use mapless_baselines::{KnownWorld, OracleConfig, PlanPose, Truth, shortest_path};
use mapless_trials::{LoadedScenario, Scenario};

use crate::error::{CampaignError, CampaignFault};
use crate::file::{Campaign, Combine};
use crate::files::tidy;
use crate::hash::{self, Hash};
use crate::navigators;
use crate::parameters;
use crate::reality::Condition;

/// All trials of a campaign.
#[derive(Debug)]
pub struct Plan {
    /// The campaign.
    pub campaign: Campaign,
    /// Its file, as named.
    pub file: String,
    /// Identity of everything that the results depend on: scenarios, terrains, planners' configurations,
    /// seeds.
    pub hash: String,
    /// The routes, by name.
    pub routes: Vec<Route>,
    /// The trials, sorted by planner, route, truth, parameters, reality and seed.
    pub trials: Vec<TrialSpec>,
}

/// A scenario with a name.
#[derive(Debug)]
pub struct Route {
    /// Name of the scenario file, without extension.
    pub name: String,
    /// The scenario file, as named relative to the campaign file.
    pub file: String,
    /// Scenario and terrain.
    pub loaded: LoadedScenario,
    /// Whether it is driven with the campaign's first seed alone.
    pub has_single_seed: bool,
}

impl Route {
    /// Straight distance from the start over the waypoints to the goal, seen from above, metres.
    pub(crate) fn straight_m(&self) -> f64 {
        let Scenario { start, waypoints_m, goal_m, .. } = &self.loaded.scenario;
        let ends = waypoints_m.iter().chain([goal_m]);
        let begins = [start.position_m].into_iter().chain(waypoints_m.iter().copied());
        begins.zip(ends).map(|(begin, end)| (*end - begin).length()).sum()
    }

    /// Length of the shortest safe path; `None` if the oracle finds none, or if there are waypoints, which it
    /// does not support. Slow.
    pub(crate) fn oracle_length_m(&self) -> Option<f64> {
        let LoadedScenario { scenario, terrain } = &self.loaded;
        let Scenario { start, waypoints_m, goal_m, .. } = scenario;
        if !waypoints_m.is_empty() {
            return None;
        }
        let start = PlanPose { position_m: start.position_m, yaw_rad: start.heading_rad };
        let path = shortest_path(
            &KnownWorld::new(&terrain.field, scenario),
            start,
            *goal_m,
            &OracleConfig::default(),
        );
        path.ok().map(|path| path.length_m)
    }
}

/// One trial to run.
#[derive(Clone, Debug)]
pub struct TrialSpec {
    /// Identity of the trial within its campaign: of its planner, route, truth, parameters, reality and seed.
    pub id: String,
    /// Name of the planner.
    pub planner: String,
    /// Index of the route.
    pub route: usize,
    /// Ground truth in place of perception.
    pub truth: Truth,
    /// `path=value` of every parameter that the campaign sets, separated by spaces.
    pub parameters: String,
    /// What else goes wrong than in the scenario.
    pub reality: Option<Arc<Condition>>,
    /// Seed of the sensor's noise.
    pub seed: u64,
    /// The planner's whole configuration, or why there is none.
    pub config: Arc<Result<PlannerConfig, String>>,
    /// Whether its trajectory is kept.
    pub keeps_trajectory: bool,
}

/// Which of several equal parts of a campaign's trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// Whether the trial at `index` of the plan belongs to this part.
    pub(crate) fn holds(self, index: usize) -> bool {
        index % self.count == self.index
    }

    /// As in the name of its journal.
    pub(crate) fn suffix(self) -> String {
        format!("-{}-of-{}", self.index + 1, self.count)
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| {
            Some((index.parse::<usize>().ok()?.checked_sub(1)?, count.parse::<usize>().ok()?))
        });
        match numbers {
            Some((index, count)) if index < count => Ok(Self { index, count }),
            _ => Err(format!("\"{text}\": expected I/N with I from 1 to N, as 2/8")),
        }
    }
}

impl Plan {
    /// Reads a campaign file with its scenarios and terrains, and expands it.
    ///
    /// # Errors
    /// [`CampaignError`] names the file, the place, the value and what was expected.
    pub fn read(path: &Path) -> Result<Self, CampaignError> {
        let campaign = Campaign::read(path)?;
        let mut routes = Vec::new();
        let single = campaign.single_seed_routes.iter().map(|file| (file, true));
        for (file, has_single_seed) in campaign.routes.iter().map(|file| (file, false)).chain(single) {
            let loaded = LoadedScenario::read(file)
                .map_err(|error| CampaignError::new(path, CampaignFault::Route(error)))?;
            routes.push(Route {
                name: file.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
                file: file.to_string_lossy().into_owned(),
                loaded,
                has_single_seed,
            });
        }
        routes.sort_by(|a, b| a.name.cmp(&b.name));
        let trials = expand(&campaign, &routes);
        let hash = identity(&campaign, &routes, &trials);
        Ok(Self { file: tidy(path).to_string_lossy().into_owned(), campaign, hash, routes, trials })
    }
}

fn expand(campaign: &Campaign, routes: &[Route]) -> Vec<TrialSpec> {
    let mut planners = campaign.planners.clone();
    let mut truths = campaign.truths.clone();
    planners.sort_unstable();
    truths.sort_unstable();
    let first_seed = campaign.seeds.first();
    let mut conditions: Vec<Arc<Condition>> = campaign.realities.iter().cloned().map(Arc::new).collect();
    conditions.sort_unstable_by(|a, b| a.name.cmp(&b.name));
    let mut trials = Vec::new();
    for planner in &planners {
        for (index, route) in routes.iter().enumerate() {
            let mut seeds = campaign.seeds_of(planner).to_vec();
            seeds.truncate(if route.has_single_seed { 1 } else { seeds.len() });
            seeds.sort_unstable();
            let base = navigators::configuration(planner, &route.loaded.scenario);
            // The others know the ground anyway.
            let applies = |truth: &&Truth| **truth == Truth::None || navigators::perceives(planner);
            for &truth in truths.iter().filter(applies) {
                for variation in &campaign.variations {
                    let config = base.clone().and_then(|base| parameters::apply(&base, variation));
                    let is_base = variation.is_empty();
                    if campaign.combine == Combine::OneAtATime && !is_base && config.is_ok() && config == base
                    {
                        continue;
                    }
                    let config = config.and_then(|config| {
                        config.validate("planner").map(|()| config).map_err(|e| e.to_string())
                    });
                    let config = Arc::new(config);
                    let parameters = parameters::name(variation);
                    let others = conditions.iter().filter(|condition| condition.is_for(planner));
                    for reality in std::iter::once(None).chain(others.map(Some)) {
                        let mut words = vec![planner, &route.name, truth.name(), &parameters];
                        words.extend(reality.map(|condition| condition.name.as_str()));
                        trials.extend(seeds.iter().map(|&seed| TrialSpec {
                            id: hash::of_words(&[&words[..], &[&seed.to_string()]].concat()),
                            planner: planner.clone(),
                            route: index,
                            truth,
                            parameters: parameters.clone(),
                            reality: reality.cloned(),
                            seed,
                            config: Arc::clone(&config),
                            keeps_trajectory: campaign.trajectories
                                && is_base
                                && truth == Truth::None
                                && reality.is_none()
                                && Some(&seed) == first_seed,
                        }));
                    }
                }
            }
        }
    }
    trials
}

fn identity(campaign: &Campaign, routes: &[Route], trials: &[TrialSpec]) -> String {
    let mut hash = Hash::default();
    hash.add(campaign.name.as_bytes());
    for Route { name, loaded, .. } in routes {
        hash.add(name.as_bytes());
        // All digits of every number are printed.
        hash.add(format!("{:?}", loaded.scenario).as_bytes());
        let field = &loaded.terrain.field;
        hash.add(format!("{} {} {}", field.columns(), field.rows(), field.cell_m()).as_bytes());
        let heights: Vec<u8> = field.heights_m().iter().flat_map(|height| height.to_le_bytes()).collect();
        hash.add(&heights);
    }
    for Condition { name, section, .. } in &campaign.realities {
        hash.add(name.as_bytes());
        hash.add(section.to_string().as_bytes());
    }
    for trial in trials {
        hash.add(trial.id.as_bytes());
        hash.add(&[u8::from(trial.keeps_trajectory)]);
    }
    // Trials of one variation share their configuration.
    for pair in trials.chunk_by(|a, b| Arc::ptr_eq(&a.config, &b.config)) {
        hash.add(format!("{:?}", pair[0].config).as_bytes());
    }
    hash.hex()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::Campaign;

    const RECIPE: &str = "name = \"Meadow\"\nsize_m = [20.0, 10.0]\ncell_m = 0.5\nseed = 5\n";
    const SCENARIO: &str =
        "terrain = \"../meadow.toml\"\nstart = [4.0, 5.0, 0.3]\ngoal = [9.0, 5.0]\nseed = 1\n";
    const CAMPAIGN: &str = "planners = [\"paper\", \"default\"]\nroutes = [\"routes/*.toml\"]\nseeds = [7, 2]\n\
        [[parameters]]\npath = \"planner.decision.distance_weight\"\nvalues = [0.3, 2.0]\n";

    fn plan(recipe: &str, scenario: &str, campaign: &str) -> Result<Plan, CampaignError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("quick.toml");
        std::fs::create_dir(folder.path().join("routes")).unwrap();
        std::fs::write(folder.path().join("meadow.toml"), recipe).unwrap();
        std::fs::write(folder.path().join("routes/east.toml"), scenario).unwrap();
        std::fs::write(folder.path().join("routes/again.toml"), scenario).unwrap();
        std::fs::write(&path, campaign).unwrap();
        Plan::read(&path)
    }

    #[test]
    fn trials_are_sorted_and_each_is_another() {
        let plan = plan(RECIPE, SCENARIO, CAMPAIGN).unwrap();
        // The paper's distance weight is 0.3, so that value is no variation of `paper`.
        assert_eq!(plan.trials.len(), 2 * (2 * 3 + 2 * 2));
        let key =
            |trial: &TrialSpec| (trial.planner.clone(), trial.route, trial.parameters.clone(), trial.seed);
        assert!(plan.trials.is_sorted_by_key(key));
        let ids: std::collections::BTreeSet<&str> =
            plan.trials.iter().map(|trial| trial.id.as_str()).collect();
        assert_eq!(ids.len(), plan.trials.len());
        assert_eq!((plan.routes[0].name.as_str(), plan.trials[0].seed), ("again", 2));
    }

    #[test]
    fn a_planner_may_drive_with_fewer_seeds() {
        let text = "planners = [\"default\", \"paper\"]\nroutes = [\"routes/*.toml\"]\nseeds = [7, 2, 9]\n\
            fewer_seeds = { paper = 2 }\n";
        let plan = plan(RECIPE, SCENARIO, text).unwrap();
        let seeds = |planner| {
            plan.trials.iter().filter(move |trial| trial.planner == planner).map(|trial| trial.seed)
        };
        assert_eq!(seeds("default").collect::<Vec<_>>(), [2, 7, 9, 2, 7, 9]);
        assert_eq!(seeds("paper").collect::<Vec<_>>(), [2, 7, 2, 7], "the first two in the file's order");
    }

    #[test]
    fn a_route_may_be_driven_with_the_first_seed_alone() {
        let text = "planners = [\"default\"]\nroutes = [\"routes/east.toml\"]\nseeds = [7, 2]\n\
            single_seed_routes = [\"routes/again.toml\"]\n";
        let plan = plan(RECIPE, SCENARIO, text).unwrap();
        let drives: Vec<(&str, u64)> =
            (plan.trials.iter()).map(|trial| (plan.routes[trial.route].name.as_str(), trial.seed)).collect();
        assert_eq!(drives, [("again", 7), ("east", 2), ("east", 7)]);
    }

    #[test]
    fn over_waypoints_the_straight_distance_has_legs_and_no_shortest_path_is_known() {
        let text = "planners = [\"default\"]\nroutes = [\"routes/*.toml\"]\nseeds = [1]\n";
        let route = |scenario: &str| plan(RECIPE, scenario, text).unwrap().routes.swap_remove(0);
        let straight = route(SCENARIO);
        assert!((straight.straight_m() - 5.0).abs() < 1e-12);
        assert!(straight.oracle_length_m().is_some_and(|length_m| length_m >= 5.0));
        let around = route(&format!("{SCENARIO}waypoints = [[4.0, 8.0], [9.0, 8.0]]\n"));
        assert!((around.straight_m() - 11.0).abs() < 1e-12);
        assert_eq!(around.oracle_length_m(), None);
    }

    #[test]
    fn a_grid_keeps_every_combination() {
        let plan = plan(RECIPE, SCENARIO, &format!("combine = \"grid\"\n{CAMPAIGN}")).unwrap();
        assert_eq!(plan.trials.len(), 2 * 2 * 2 * 2);
        assert!(plan.trials.iter().all(|trial| !trial.parameters.is_empty()));
    }

    #[test]
    fn the_identity_follows_what_decides_the_results() {
        let hash =
            |recipe: &str, scenario: &str, campaign: &str| plan(recipe, scenario, campaign).unwrap().hash;
        let first = hash(RECIPE, SCENARIO, CAMPAIGN);
        assert_eq!(hash(RECIPE, &format!("# a remark\n{SCENARIO}"), CAMPAIGN), first);
        assert_eq!(
            hash(RECIPE, SCENARIO, &CAMPAIGN.replace("\"paper\", \"default\"", "\"default\", \"paper\"")),
            first
        );
        let noise = "[[noise]]\namplitude_m = 0.2\nwavelength_m = 6.0\noctaves = 2\n";
        for other in [
            hash(&format!("{RECIPE}{noise}"), SCENARIO, CAMPAIGN),
            hash(RECIPE, &SCENARIO.replace("9.0", "9.5"), CAMPAIGN),
            hash(RECIPE, &format!("{SCENARIO}[planner.decision]\nspin_recovery_s = 0.5\n"), CAMPAIGN),
            hash(RECIPE, SCENARIO, &CAMPAIGN.replace('7', "8")),
            hash(RECIPE, SCENARIO, &format!("trajectories = true\n{CAMPAIGN}")),
        ] {
            assert_ne!(other, first);
        }
    }

    #[test]
    fn every_condition_is_driven_by_its_planners_beside_the_scenarios_own() {
        let base = plan(RECIPE, SCENARIO, CAMPAIGN).unwrap();
        let text = format!(
            "{CAMPAIGN}[[realities]]\nname = \"wet\"\nreality = {{ motion = {{ friction = 0.4 }} }}\n\
             [[realities]]\nname = \"field\"\nreality = {{ preset = \"field\" }}\nplanners = [\"paper\"]\n"
        );
        let plan = |text: &str| plan(RECIPE, SCENARIO, text).unwrap();
        let with = plan(&text);
        let of = |planner: &str, name: Option<&str>| {
            let is_of = move |trial: &&TrialSpec| {
                trial.planner == planner
                    && trial.reality.as_ref().map(|reality| reality.name.as_str()) == name
            };
            with.trials.iter().filter(is_of).count()
        };
        assert_eq!([None, Some("field"), Some("wet")].map(|name| of("paper", name)), [8, 8, 8]);
        assert_eq!([None, Some("field"), Some("wet")].map(|name| of("default", name)), [12, 0, 12]);
        let ids = |plan: &Plan| -> std::collections::BTreeSet<String> {
            plan.trials.iter().map(|trial| trial.id.clone()).collect()
        };
        assert_eq!(ids(&with).len(), with.trials.len());
        assert!(ids(&with).is_superset(&ids(&base)), "trials in the scenarios' own reality keep their ids");
        assert_ne!(plan(&text.replace("0.4", "0.5")).hash, with.hash);
    }

    #[test]
    fn a_value_outside_its_range_is_kept_for_the_rows() {
        let plan = plan(RECIPE, SCENARIO, &CAMPAIGN.replace("2.0", "-2.0")).unwrap();
        let faults: Vec<&String> =
            plan.trials.iter().filter_map(|trial| trial.config.as_ref().as_ref().err()).collect();
        assert_eq!(faults.len(), 2 * 2 * 2);
        assert!(faults[0].contains("distance_weight = -2"), "{}", faults[0]);
    }

    #[test]
    fn a_broken_scenario_is_named() {
        let error = plan(RECIPE, "terrain = 3", CAMPAIGN).unwrap_err().to_string();
        assert!(error.contains("quick.toml: routes: ") && error.contains("again.toml"), "{error}");
    }

    #[test]
    fn shards_part_the_trials() {
        let shard = |text: &str| text.parse::<Shard>();
        let parts: Vec<Shard> = (1..=3).map(|index| shard(&format!("{index}/3")).unwrap()).collect();
        for trial in 0..20 {
            assert_eq!(parts.iter().filter(|part| part.holds(trial)).count(), 1);
        }
        for bad in ["", "1", "0/2", "3/2", "a/b", "1/0", "1/2/3"] {
            assert!(shard(bad).unwrap_err().contains("expected I/N"), "{bad}");
        }
    }

    #[test]
    fn a_campaign_file_that_is_not_there_is_named() {
        let error = Campaign::read(Path::new("nowhere.toml")).unwrap_err().to_string();
        assert!(error.starts_with("nowhere.toml: cannot be read: "), "{error}");
    }
}
