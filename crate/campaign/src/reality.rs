//! Conditions of a campaign: what else may go wrong than in the scenarios.

/// A condition: a name, and what goes wrong in the trials of that name.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Its name in rows and reports.
    pub name: String,
    /// A section `[reality]` that is laid over each scenario's own: see
    /// [`mapless_trials::RealityConfig::with_section`].
    pub section: toml::Table,
    /// The planners that drive in it, where they are not all.
    pub planners: Option<Vec<String>>,
}

impl Condition {
    /// `key=value` of everything that it sets, separated by spaces, as `motion.friction=0.4`.
    pub(crate) fn sets(&self) -> String {
        let mut words = Vec::new();
        for (key, value) in &self.section {
            match value {
                toml::Value::Table(table) => {
                    words.extend(table.iter().map(|(name, value)| format!("{key}.{name}={value}")));
                }
                _ => words.push(format!("{key}={value}")),
            }
        }
        words.join(" ")
    }

    /// Whether `planner` drives in it.
    pub(crate) fn is_for(&self, planner: &str) -> bool {
        self.planners.as_ref().is_none_or(|planners| planners.iter().any(|name| name == planner))
    }
}
