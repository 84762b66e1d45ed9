//! The paper's own numbers.

use crate::error::CampaignError;

/// One row of the paper's tables.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PublishedRow {
    /// Name of the scenario modelled on the paper's route.
    pub(super) route: String,
    /// `paper` for the paper's method, `VGF` for its baseline.
    pub(super) method: String,
    /// In the order of [`super::METRICS`].
    pub(super) mean: [f64; 6],
    /// Standard deviations, if the paper gives them.
    pub(super) deviation: Option<[f64; 6]>,
}

#[derive(serde::Deserialize)]
struct File {
    rows: Vec<PublishedRow>,
}

/// The paper's Tables I and II, from the file that the page reads too.
pub(super) fn published() -> Result<Vec<PublishedRow>, CampaignError> {
    let file: Result<File, _> = serde_json::from_str(include_str!("../../../../terrains/published.json"));
    file.map(|file| file.rows)
        .map_err(|error| CampaignError::content("terrains/published.json".as_ref(), error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_tables_are_complete() {
        let rows = published().unwrap();
        let of = |method: &str| rows.iter().filter(|row| row.method == method).count();
        assert_eq!((of("paper"), of("VGF"), rows.len()), (7, 5, 12));
        // The paper's text: "on curvature change the map-based approach yielded superior outcomes".
        for vgf in rows.iter().filter(|row| row.method == "VGF") {
            let paper = rows.iter().find(|row| row.method == "paper" && row.route == vgf.route).unwrap();
            assert!(vgf.mean[5] < paper.mean[5] && vgf.mean[3] > paper.mean[3], "{}", vgf.route);
        }
    }
}
