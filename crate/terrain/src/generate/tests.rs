use super::*;
use crate::{Fault, Grid, Import, load_recipe};
use mapless_world::{HeightField, SlopeDistribution};
use proptest::prelude::*;

fn no_import(_: &str, _: &Import) -> Result<Grid, Fault> {
    Err(Fault::Read { reason: "no imports".to_owned() })
}

fn field(family: Family, seed: u64) -> HeightField {
    let recipe = terrain_recipe("x", family, seed);
    let terrain = load_recipe("x.toml", recipe.as_bytes(), &mut no_import);
    terrain.unwrap_or_else(|error| panic!("{error}\n{recipe}")).field
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn every_seed_makes_a_terrain(seed in any::<u64>()) {
        for family in Family::ALL {
            let extent_m = field(family, seed).extent_m();
            prop_assert!((45.0 - 1e-9..=80.0 + 1e-9).contains(&extent_m.x));
            prop_assert_eq!(extent_m.x, extent_m.y);
        }
    }
}

#[test]
fn a_seed_repeats_and_differs_from_others() {
    let recipe = |difficulty, seed| terrain_recipe("x", Family::Ground(difficulty), seed);
    assert_eq!(recipe(Difficulty::Hard, 7), recipe(Difficulty::Hard, 7));
    assert_ne!(recipe(Difficulty::Hard, 7), recipe(Difficulty::Hard, 8));
    assert_ne!(recipe(Difficulty::Hard, 7), recipe(Difficulty::Easy, 7));
}

#[test]
fn names_are_quoted_and_read_back() {
    let recipe = terrain_recipe("a \"b\"", Family::Ground(Difficulty::Easy), 1);
    let terrain = load_recipe("x.toml", recipe.as_bytes(), &mut no_import).unwrap();
    assert_eq!(terrain.name, "a \"b\"");
    for family in Family::ALL {
        assert_eq!(family.name().parse(), Ok(family));
    }
    let error = "harsh".parse::<Family>().unwrap_err();
    let expected = "expected one of easy, moderate, hard, rocks, posts, walls, ditches, mixed, movers";
    assert_eq!(error.to_string(), format!("family \"harsh\": {expected}"));
}

/// Over many terrains a harder level is steeper by every measure.
#[test]
fn harder_is_steeper() {
    let mean = |difficulty, measure: &dyn Fn(&SlopeDistribution) -> f64| {
        (0..12)
            .map(|seed| {
                measure(
                    &SlopeDistribution::of(&field(Family::Ground(difficulty), seed), BANK_REACH_M).unwrap(),
                )
            })
            .sum::<f64>()
            / 12.0
    };
    let measures: [&dyn Fn(&SlopeDistribution) -> f64; 4] = [
        &|slopes| slopes.quantile_rad(0.5),
        &|slopes| slopes.quantile_rad(0.9),
        &|slopes| slopes.share_above(0.524),
        &|slopes| slopes.relief_m,
    ];
    for (index, measure) in measures.into_iter().enumerate() {
        let [easy, moderate, hard] = Difficulty::ALL.map(|difficulty| mean(difficulty, measure));
        println!("measure {index}: {easy:.3} {moderate:.3} {hard:.3}");
        assert!(1.2 * easy < moderate && 1.2 * moderate < hard, "{index}: {easy} {moderate} {hard}");
    }
}

/// The same text on every target: its bytes are those of the first time.
#[test]
fn a_recipe_is_what_it_was() {
    let recipe = terrain_recipe("x", Family::Ground(Difficulty::Moderate), 1);
    let sum = recipe.bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    assert_eq!(sum, 2_065_456_846_370_119_226, "{recipe}");
}
