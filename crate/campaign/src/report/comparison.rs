//! Comparison of planners: sentences generated from the numbers.

use std::collections::HashSet;
use std::fmt::{self, Write as _};
use std::ops::Range;

use super::published::PublishedRow;
use super::{METRICS, Metric, Results, failures, rate, stats, values};
use crate::row::TrialRow;

/// Means that differ by less than this share are even.
pub(super) const EVEN: f64 = 0.005;

/// At most this many routes are named as those with the most failures.
const MOST_NAMED: usize = 3;

/// The safety metrics of [`METRICS`].
const SAFETY: Range<usize> = 1..5;
const ELEVATION_RATE: usize = 4;
/// Height gained plus height lost: the elevation rate times the time.
const UP_AND_DOWN: Metric = Metric {
    heading: "up and down, m",
    decimals: 1,
    of: |row| Some(0.01 * row.mean_elevation_rate_cm_s? * row.sim_time_s?),
};

/// One metric of two methods over several routes.
pub(super) struct Contest {
    pub(super) metric: &'static str,
    /// Routes on which the first is lower, and on which it is higher; the others are even.
    pub(super) lower: usize,
    pub(super) higher: usize,
    pub(super) routes: usize,
    /// Mean over the routes of first / second - 1.
    pub(super) change: f64,
}

impl Contest {
    /// The number of routes on the majority side, and that side.
    pub(super) fn side(&self) -> (usize, &'static str) {
        if self.higher > self.lower { (self.higher, "higher") } else { (self.lower, "lower") }
    }

    /// The change in words.
    pub(super) fn percent(&self) -> String {
        format!("{:+.0} %", 100.0 * self.change)
    }
}

/// Where the first planner wins, where it loses, and how it fails.
pub(super) fn of_the_first(text: &mut String, results: &Results, published: &[PublishedRow]) -> fmt::Result {
    let Some((first, others)) = results.manifest.planners.split_first() else { return Ok(()) };
    writeln!(text, "\nWhere `{first}` wins, where it loses:\n")?;
    against_published(text, results, published, first)?;
    let groups = results.groups();
    for other in others {
        let pairs = groups.iter().map(|group| {
            let [ours, theirs] = shared(results, [first, other], group);
            (means(&ours), means(&theirs))
        });
        writeln!(text, "{}", against(first, &format!("`{other}`"), &contests(pairs)))?;
        writeln!(text, "{}", successes([first, other], [&all_of(results, first), &all_of(results, other)]))?;
        if let Some(sentences) = where_higher(results, [first, other]) {
            writeln!(text, "{sentences}")?;
        }
    }
    writeln!(text, "{}", failing(results, first))
}

/// The same of the other planners, beside the paper alone.
pub(super) fn of_the_others(text: &mut String, results: &Results, published: &[PublishedRow]) -> fmt::Result {
    let others = results.manifest.planners.get(1..).unwrap_or_default();
    if others.is_empty() {
        return Ok(());
    }
    writeln!(text, "\n## The other planners\n")?;
    for planner in others {
        against_published(text, results, published, planner)?;
        writeln!(text, "{}", failing(results, planner))?;
    }
    Ok(())
}

/// A planner against the numbers that the paper gives of both methods, where the routes are the paper's.
fn against_published(
    text: &mut String,
    results: &Results,
    published: &[PublishedRow],
    planner: &str,
) -> fmt::Result {
    let groups = results.groups();
    if !published.iter().any(|row| groups.contains(&row.route.as_str())) {
        return Ok(());
    }
    for (method, name) in
        [("paper", "the published numbers of the paper's method"), ("VGF", "the published numbers of VGF")]
    {
        let pairs = (published.iter().filter(|row| row.method == method)).filter_map(|row| {
            let ours = results.of(planner, groups.iter().find(|group| **group == row.route)?);
            Some((means(&ours), row.mean.map(Some)))
        });
        writeln!(text, "{}", against(planner, name, &contests(pairs)))?;
    }
    Ok(())
}

fn all_of<'a>(results: &'a Results, planner: &str) -> Vec<&'a TrialRow> {
    results.plain().filter(|row| row.planner == planner).collect()
}

/// The trials of both planners on those routes of a group that both reached. Other routes would compare
/// different ground, to the disadvantage of a planner that reaches the hard ones.
fn shared<'a>(results: &'a Results, planners: [&str; 2], group: &str) -> [Vec<&'a TrialRow>; 2] {
    let of_both = planners.map(|planner| results.of(planner, group));
    let reached = of_both.each_ref().map(|rows| -> HashSet<&str> {
        rows.iter().filter(|row| row.has_reached()).map(|row| row.route.as_str()).collect()
    });
    of_both.map(|mut rows| {
        rows.retain(|row| reached.iter().all(|routes| routes.contains(row.route.as_str())));
        rows
    })
}

fn means(rows: &[&TrialRow]) -> [Option<f64>; 6] {
    METRICS.each_ref().map(|metric| stats::mean(&values(rows, metric)))
}

/// Every metric that the pairs have, the first of each against its second.
pub(super) fn contests(pairs: impl Iterator<Item = ([Option<f64>; 6], [Option<f64>; 6])>) -> Vec<Contest> {
    let pairs: Vec<_> = pairs.collect();
    let contest = |(index, metric): (usize, &super::Metric)| {
        let ratios: Vec<f64> = pairs
            .iter()
            .filter_map(|(ours, theirs)| Some(ours[index]? / theirs[index].filter(|value| *value > 0.0)?))
            .collect();
        Some(Contest {
            metric: metric.name(),
            lower: ratios.iter().filter(|ratio| **ratio < 1.0 - EVEN).count(),
            higher: ratios.iter().filter(|ratio| **ratio > 1.0 + EVEN).count(),
            routes: ratios.len(),
            change: stats::mean(&ratios)? - 1.0,
        })
    };
    METRICS.iter().enumerate().filter_map(contest).collect()
}

/// A sentence about the metrics that are lower on most routes, and one about the rest; `None` if there is
/// nothing to compare.
fn against(planner: &str, other: &str, contests: &[Contest]) -> String {
    let Some(first) = contests.first() else {
        return format!("- `{planner}` against {other}: no route to compare on.");
    };
    let list = |verb: &str, of: &dyn Fn(&Contest) -> bool| {
        let words = contests.iter().filter(|contest| of(contest)).map(|contest| {
            let (count, side) = contest.side();
            let Contest { metric, routes, .. } = contest;
            format!("{metric} ({side} on {count} of {routes}, {} on average)", contest.percent())
        });
        let words: Vec<String> = words.collect();
        (!words.is_empty()).then(|| format!("{verb} {}", words.join(", ")))
    };
    let verdicts = [
        list("wins in", &|contest| 2 * contest.lower > contest.routes),
        list("loses in", &|contest| 2 * contest.higher > contest.routes),
        list("even in", &|contest| 2 * contest.lower.max(contest.higher) <= contest.routes),
    ];
    let verdicts: Vec<String> = verdicts.into_iter().flatten().collect();
    let routes = if first.routes == 1 { "route" } else { "routes" };
    format!("- `{planner}` against {other}, on {} {routes}: {}.", first.routes, verdicts.join("; "))
}

fn successes([one, other]: [&str; 2], [ones, others]: [&[&TrialRow]; 2]) -> String {
    let reached = |rows: &[&TrialRow]| rows.iter().filter(|row| row.has_reached()).count();
    let interval = |rows: &[&TrialRow]| stats::wilson(reached(rows), rows.len());
    let ((one_low, one_high), (other_low, other_high)) = (interval(ones), interval(others));
    let verdict = if one_low > other_high {
        "reaches more often, beyond the 95 % intervals"
    } else if one_high < other_low {
        "reaches less often, beyond the 95 % intervals"
    } else {
        "differs in success by less than the 95 % intervals"
    };
    format!("- `{one}` {verdict}: {} against {} of `{other}`.", rate(ones), rate(others))
}

/// The routes on which a planner has a higher value of a safety metric than another; and, for the elevation
/// rate, how far up and down both go there.
fn where_higher(results: &Results, [one, other]: [&str; 2]) -> Option<String> {
    let means = |group: &str, metric: &Metric| {
        let [ours, theirs] =
            shared(results, [one, other], group).map(|rows| stats::mean(&values(&rows, metric)));
        ours.zip(theirs)
    };
    let routes_of = |metric: &Metric| {
        let mut routes = results.groups();
        routes
            .retain(|route| means(route, metric).is_some_and(|(ours, theirs)| ours > (1.0 + EVEN) * theirs));
        routes
    };
    let lists = METRICS[SAFETY].iter().filter_map(|metric| {
        let routes = routes_of(metric);
        (!routes.is_empty()).then(|| format!("in {} on {}", metric.name(), routes.join(", ")))
    });
    let lists: Vec<String> = lists.collect();
    if lists.is_empty() {
        return None;
    }
    let climbing = routes_of(&METRICS[ELEVATION_RATE]);
    let over_all = |metric: &Metric| {
        let (ours, theirs): (Vec<f64>, Vec<f64>) =
            climbing.iter().filter_map(|route| means(route, metric)).unzip();
        stats::mean(&ours).zip(stats::mean(&theirs))
    };
    let both = over_all(&UP_AND_DOWN).zip(over_all(&METRICS[0]));
    let climbs = both.map_or_else(String::new, |((up, their_up), (path, their_path))| {
        format!(
            " On those with a higher elevation rate, it goes {up:.1} m up and down in the mean, on a path of \
             {path:.1} m; `{other}` goes {their_up:.1} m on {their_path:.1} m."
        )
    });
    Some(format!("- `{one}` is higher than `{other}` {}.{climbs}", lists.join("; ")))
}

/// How the planner fails, and on which routes most.
fn failing(results: &Results, planner: &str) -> String {
    let rows = all_of(results, planner);
    let failed: Vec<&&TrialRow> = rows.iter().filter(|row| !row.has_reached()).collect();
    if failed.is_empty() {
        return format!("- `{planner}` fails nowhere here.");
    }
    let mut routes: Vec<(&str, usize)> = Vec::new();
    for row in &failed {
        let group = results.group(&row.route);
        match routes.iter_mut().find(|(route, _)| *route == group) {
            Some((_, count)) => *count += 1,
            None => routes.push((group, 1)),
        }
    }
    routes.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    // If the next route has as many failures, the first three are not the only ones with the most.
    let next = routes.get(MOST_NAMED).map_or(0, |&(_, count)| count);
    let most = routes.iter().take(MOST_NAMED).filter(|&&(_, count)| count > next);
    let most: Vec<String> = most.map(|(route, count)| format!("{route} ({count})")).collect();
    let most = if most.is_empty() { String::new() } else { format!("; most on {}", most.join(", ")) };
    format!("- `{planner}` fails in {} of {} trials: {}{most}.", failed.len(), rows.len(), failures(&rows))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::published::published;
    use crate::testing::{results, row};

    #[test]
    fn ground_that_the_paper_has_not_is_not_compared_with_its_numbers() {
        let text_of = |route: &str| {
            let rows =
                vec![row("default", route, "none", 1, "reached"), row("default", route, "none", 2, "stuck")];
            let mut text = String::new();
            of_the_first(&mut text, &results(&["default"], &[route], rows), &published().unwrap()).unwrap();
            text
        };
        assert!(text_of("ml").contains("the published numbers of the paper's method"));
        let generated = text_of("hard-1-0001");
        assert!(
            !generated.contains("published") && generated.contains("1 stuck; most on hard-1-0001 (1)"),
            "{generated}"
        );
    }

    #[test]
    fn of_routes_with_as_many_failures_none_is_named_the_worst() {
        let failing = |counts: &[u64]| {
            let names = ["a", "b", "c", "d", "e"];
            let of_route = |(name, &count): (&str, &u64)| -> Vec<TrialRow> {
                (0..count).map(|seed| row("flat", name, "none", seed, "stuck")).collect()
            };
            let rows = names.into_iter().zip(counts).flat_map(of_route).collect();
            failing(&results(&["flat"], &names, rows), "flat")
        };
        assert_eq!(failing(&[1, 1, 1, 1, 1]), "- `flat` fails in 5 of 5 trials: 5 stuck.");
        assert!(failing(&[1, 3, 1, 1, 2]).ends_with("8 stuck; most on b (3), e (2)."));
        assert!(failing(&[2, 2, 2, 1]).ends_with("; most on a (2), b (2), c (2)."));
    }

    #[test]
    fn the_routes_that_are_lost_are_named_with_their_climb() {
        let driven = |planner, route, pitch_rad, rate_cm_s, path_m| TrialRow {
            max_abs_pitch_rad: Some(pitch_rad),
            mean_elevation_rate_cm_s: Some(rate_cm_s),
            distance_m: Some(path_m),
            sim_time_s: Some(100.0),
            ..row(planner, route, "none", 1, "reached")
        };
        let rows = vec![
            driven("default", "a", 0.2, 4.0, 50.0),
            driven("vgf", "a", 0.1, 2.0, 60.0),
            driven("default", "b", 0.3, 3.0, 50.0),
            driven("vgf", "b", 0.2, 6.0, 50.0),
        ];
        let results = results(&["default", "vgf"], &["a", "b"], rows);
        assert_eq!(
            where_higher(&results, ["default", "vgf"]).unwrap(),
            "- `default` is higher than `vgf` in max \\|pitch\\| on a, b; in elevation rate on a. On those \
             with a higher elevation rate, it goes 4.0 m up and down in the mean, on a path of 50.0 m; `vgf` goes \
             2.0 m on 60.0 m."
        );
        assert!(where_higher(&results, ["vgf", "default"]).unwrap().contains("in elevation rate on b"));
        assert_eq!(where_higher(&results, ["default", "default"]), None);
    }

    #[test]
    fn planners_are_compared_on_what_both_reach() {
        let names: Vec<String> = (0..20).map(|index| format!("hard-1-{index:04}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let driven = |planner, route, outcome, path_m| TrialRow {
            distance_m: Some(path_m),
            ..row(planner, route, "none", 1, outcome)
        };
        let rows = vec![
            driven("default", names[0], "reached", 50.0),
            driven("paper", names[0], "reached", 60.0),
            driven("default", names[1], "reached", 200.0),
            driven("paper", names[1], "tilt_limit", 5.0),
        ];
        let mut text = String::new();
        of_the_first(&mut text, &results(&["default", "paper"], &names, rows), &[]).unwrap();
        assert!(text.contains("wins in distance (lower on 1 of 1, -17 % on average)"), "{text}");
    }

    #[test]
    fn sentences_follow_the_numbers() {
        let ours = [Some(8.0), Some(0.4), Some(0.2), Some(0.1), Some(5.0), Some(0.6)];
        let theirs = [Some(10.0), Some(0.5), Some(0.4), Some(0.2), Some(5.0), Some(0.1)];
        let sentence = against("default", "them", &contests([(ours, theirs), (ours, [None; 6])].into_iter()));
        assert!(sentence.starts_with(
            "- `default` against them, on 1 route: wins in distance (lower on 1 of 1, -20 % on average)"
        ));
        assert!(
            sentence.contains("; loses in curvature change (higher on 1 of 1, +500 % on average); even in elevation rate (lower on 0 of 1, +0 %"),
            "{sentence}"
        );
        let none = against("default", "them", &contests([(ours, [None; 6])].into_iter()));
        assert!(none.ends_with("no route to compare on."));
        assert!(against("a", "b", &contests([(theirs, ours)].into_iter())).contains("loses in distance"));
    }
}
