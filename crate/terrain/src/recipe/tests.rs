//! Recipes as a designer writes them.

use super::canvas::MAX_TOUCHED_SAMPLES;
use super::*;
use crate::generate::{Family, terrain_recipe};
use glam::DVec2;
use proptest::prelude::*;

const LEVEL: &str = "name = \"test\"\nsize_m = [20.0, 10]\ncell_m = 0.25\n";

fn build(text: &str) -> Result<Terrain, TerrainError> {
    load("test.toml", text, &mut |_, _| Err(Fault::Read { reason: "no such file".to_owned() }))
}

fn field(features: &str) -> HeightField {
    build(&format!("{LEVEL}{features}")).unwrap().field
}

fn fault(features: &str) -> String {
    build(&format!("{LEVEL}{features}")).unwrap_err().to_string()
}

fn height(field: &HeightField, x: f64, y: f64) -> f64 {
    field.height_m(DVec2::new(x, y)).unwrap()
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-5, "{found}, expected {expected}");
}

#[test]
fn base_and_tilt() {
    let field = field("base_m = 3\ntilt = [0.1, -0.2]\n");
    assert_eq!((field.columns(), field.rows()), (81, 41));
    near(height(&field, 0.0, 0.0), 3.0);
    near(height(&field, 20.0, 10.0), 3.0);
    near(height(&field, 20.0, 0.0), 5.0);
}

#[test]
fn hill_with_stretch_and_heading() {
    let field = field(
        "[[hill]]\ncentre = [10, 5]\nheight_m = 2\nradius_m = 1\nstretch = 2\nheading_rad = 1.5707963267948966\n",
    );
    near(height(&field, 10.0, 5.0), 2.0);
    near(height(&field, 11.0, 5.0), 2.0 * libm::exp(-0.5));
    near(height(&field, 10.0, 7.0), 2.0 * libm::exp(-0.5));
    near(height(&field, 0.0, 0.0), 0.0);
}

#[test]
fn plateau_and_crater_profiles() {
    let plateau = field("[[plateau]]\ncentre = [10, 5]\nheight_m = 3\ntop_radius_m = 1\nflank_m = 2\n");
    for (x, expected) in [(10.0, 3.0), (11.0, 3.0), (12.0, 1.5), (13.0, 0.0), (15.0, 0.0)] {
        near(height(&plateau, x, 5.0), expected);
    }
    let crater = field("[[crater]]\ncentre = [10, 5]\nradius_m = 2\ndepth_m = 1\nrim_height_m = 0.5\n");
    for (x, expected) in [(10.0, -1.0), (11.0, -0.25), (12.0, 0.5), (8.0, 0.5), (17.0, 0.0)] {
        near(height(&crater, x, 5.0), expected);
    }
}

#[test]
fn ridge_and_valley_follow_their_line() {
    let ridge = field("[[ridge]]\npoints = [[2, 5], [18, 5]]\nheight_m = [1, 3]\nwidth_m = 0.5\n");
    for (x, y, expected) in
        [(2.0, 5.0, 1.0), (10.0, 5.0, 2.0), (18.0, 5.0, 3.0), (10.0, 5.5, 2.0 * libm::exp(-0.5))]
    {
        near(height(&ridge, x, y), expected);
    }
    let valley = field("[[valley]]\npoints = [[2, 5], [18, 5]]\ndepth_m = [1, 3]\nwidth_m = 0.5\n");
    for (down, up) in valley.heights_m().iter().zip(ridge.heights_m()) {
        assert!((down + up).abs() < 1e-6);
    }
}

#[test]
fn features_add_up() {
    let hill = "[[hill]]\ncentre = [5, 5]\nheight_m = 2\nradius_m = 1\n";
    let crater = "[[crater]]\ncentre = [7, 5]\nradius_m = 2\ndepth_m = 1\nrim_height_m = 0.5\n";
    let (one, other, both) = (field(hill), field(crater), field(&format!("{crater}{hill}")));
    for index in 0..both.heights_m().len() {
        assert!((one.heights_m()[index] + other.heights_m()[index] - both.heights_m()[index]).abs() < 1e-5);
    }
}

#[test]
fn noise_follows_the_seed_and_stays_in_its_amplitude() {
    let noise = "[[noise]]\namplitude_m = 0.4\nwavelength_m = 4\noctaves = 3\n";
    let seeded = |seed: u32| field(&format!("seed = {seed}\n{noise}"));
    let one = seeded(1);
    let (low, high) = one.height_range_m();
    assert!(low < -0.1 && high > 0.1 && low > -0.7 && high < 0.7, "{low} {high}");
    assert_eq!(one, seeded(1));
    assert_ne!(one, seeded(2));
    let twice = field(&format!("seed = 1\n{noise}{noise}"));
    assert!(
        (twice.heights_m()[500] - 2.0 * one.heights_m()[500]).abs() > 1e-4,
        "each table has its own pattern"
    );
}

#[test]
fn a_trail_cuts_a_level_road_into_a_flank() {
    let flank = "tilt = [0.0, 0.5]\n";
    let trail = "[[trail]]\npoints = [[2, 5], [18, 5]]\nwidth_m = 2\nshoulder_m = 1.5\n";
    let field = field(&format!("{flank}{trail}"));
    for (y, expected) in [(5.0, 2.5), (4.25, 2.5), (5.75, 2.5), (2.0, 1.0), (8.0, 4.0)] {
        near(height(&field, 10.0, y), expected);
    }
    let shoulder = height(&field, 10.0, 6.75);
    assert!(shoulder > 2.5 && shoulder < 3.375, "{shoulder}");
}

#[test]
fn a_trail_smooths_bumps_or_takes_given_heights() {
    let bump = "[[hill]]\ncentre = [10, 5]\nheight_m = 1\nradius_m = 0.5\n";
    let trail = "[[trail]]\npoints = [[2, 5], [18, 5]]\nwidth_m = 1\nshoulder_m = 1\n";
    let smoothed = field(&format!("{bump}{trail}smoothing_m = 10\n"));
    let crest = height(&smoothed, 10.0, 5.0);
    assert!((0.1..0.4).contains(&crest), "{crest}");
    near(height(&field(&format!("{bump}{trail}smoothing_m = 0\n")), 10.0, 5.0), 1.0);
    let given = field(&format!("{bump}{trail}height_m = [1, 3]\n"));
    near(height(&given, 10.0, 5.0), 2.0);
    near(height(&given, 2.0, 5.0), 1.0);
}

#[test]
fn faults_name_file_line_table_value_and_expectation() {
    let hill = "[[hill]]\ncentre = [1, 1]\nheight_m = 1\nradius_m = 1\n";
    assert_eq!(
        fault(&format!("{hill}{}", hill.replace("radius_m = 1", "radius_m = -2"))),
        "test.toml: line 8, hill[2].radius_m = -2: expected a finite number above 0"
    );
    assert!(fault(&hill.replace("height_m = 1", "height_m = nan")).contains("hill[1].height_m = NaN"));
    assert!(fault(&hill.replace("[1, 1]", "[inf, 1]")).contains("hill[1].centre = [inf, 1.0]"));
    for (features, expected) in [
        (
            "[[ridge]]\npoints = [[1, 1]]\nheight_m = 1\nwidth_m = 1\n",
            "ridge[1].points = [[1.0, 1.0]]: expected at least two points",
        ),
        (
            "[[ridge]]\npoints = [[1, 1], [1, 1]]\nheight_m = 1\nwidth_m = 1\n",
            "ridge[1].points[2] = [1.0, 1.0]: expected a point at least 1 cm",
        ),
        (
            "[[valley]]\npoints = [[1, 1], [2, 1]]\ndepth_m = [1, 2, 3]\nwidth_m = 1\n",
            "valley[1].depth_m = [1.0, 2.0, 3.0]: expected one number, or one for each of the 2 points",
        ),
        (
            "[[valley]]\npoints = [[1, 1], [2, 1]]\ndepth_m = \"deep\"\nwidth_m = 1\n",
            "expected a number, or a list with one number per point",
        ),
        (
            "[[trail]]\npoints = [[1, 1], [99, 1]]\nwidth_m = 1\nshoulder_m = 1\n",
            "trail[1].points[2] = [99.0, 1.0]: expected a point on the terrain",
        ),
        (
            "[[noise]]\namplitude_m = 1\nwavelength_m = 1\noctaves = 4\n",
            "noise[1].octaves = 4: expected 1 to 2",
        ),
        (
            "[[noise]]\namplitude_m = 1\nwavelength_m = 0.1\noctaves = 1\n",
            "noise[1].wavelength_m = 0.1: expected at least two cells",
        ),
        (
            "[[hill]]\ncentre = [1, 1]\nheight_m = 1e9\nradius_m = 1\n",
            "height 367879460 m at column 0, row 0",
        ),
        ("tilt = [nan, 0]\n", "tilt = NaN: expected a finite number"),
        ("[import]\nfile = \"a.png\"\n", "size_m, cell_m = present: expected none of them"),
    ] {
        let message = fault(features);
        assert!(message.starts_with("test.toml: ") && message.contains(expected), "{message}");
    }
}

#[test]
fn syntax_faults_name_line_and_column() {
    let unknown = fault("[[hill]]\ncentre = [1, 1]\nheight_m = 1\nradius = 1\n");
    assert!(unknown.contains("line 7, column 1") && unknown.contains("unknown field `radius`"), "{unknown}");
    let kind = fault("[[mountain]]\nheight_m = 1\n");
    assert!(kind.contains("unknown field `mountain`"), "{kind}");
    let missing = fault("[[hill]]\ncentre = [1, 1]\n");
    assert!(missing.contains("missing field `height_m`") && missing.contains("line 4"), "{missing}");
}

#[test]
fn sizes_are_checked_before_anything_is_allocated() {
    let sized = |size: &str, cell: &str| {
        build(&format!("name = \"t\"\nsize_m = {size}\ncell_m = {cell}\n")).unwrap_err().to_string()
    };
    assert_eq!(
        sized("[10.1, 10.0]", "0.25"),
        "test.toml: size_m = [10.1, 10.0]: expected positive multiples of cell_m = 0.25"
    );
    assert!(sized("[-10.0, 10.0]", "0.25").contains("expected positive multiples"));
    assert!(sized("[nan, 10.0]", "0.25").contains("expected positive multiples"));
    assert!(sized("[10.0, 10.0]", "nan").contains("expected positive multiples"));
    assert!(sized("[1e15, 1e15]", "1.0").contains("expected at most 16777216"));
    assert!(sized("[1e30, 1e30]", "1.0").contains("expected at most 16777216"));
    assert!(sized("[10.0, 10.0]", "0.001").contains("spacing of 0.001 m"));
    assert!(build("name = \"t\"\n").unwrap_err().to_string().contains("size_m = absent"));
}

#[test]
fn an_imported_grid_is_the_ground_for_features() {
    let asc = b"ncols 3\nnrows 3\ncellsize 2\n1 1 1\n1 1 1\n1 1 1\n";
    let text = "name = \"i\"\nbase_m = 4\n[import]\nfile = \"g.asc\"\ncell_m = 0.5\n[[hill]]\ncentre = [0.5, 0.5]\nheight_m = 1\nradius_m = 0.1\n";
    let mut asked = String::new();
    let terrain = load("dir/test.toml", text, &mut |file, import| {
        asked = file.to_owned();
        mapless_heights::read(file, asc, import)
    })
    .unwrap();
    assert_eq!(asked, "g.asc");
    assert_eq!(terrain.field.cell_m(), 0.5);
    near(height(&terrain.field, 0.5, 0.5), 6.0);
    near(height(&terrain.field, 1.0, 1.0), 5.0);
}

#[test]
fn import_faults() {
    let import = |lines: &str| build(&format!("name = \"i\"\n[import]\n{lines}")).unwrap_err().to_string();
    assert_eq!(import("file = \"g.asc\"\n"), "g.asc: cannot be read: no such file");
    assert!(import("file = \"/g.asc\"\n").contains("import.file = \"/g.asc\""));
    assert!(import("file = \"self.toml\"\n").contains("import.file"));
    assert!(
        import("file = \"g.png\"\nheight_min_m = 1\n").contains("= 1, absent: expected two finite heights")
    );
    assert!(
        import("file = \"g.asc\"\nheight_min_m = 1\nheight_max_m = 2\n").contains("a grid that has its own")
    );
    assert!(
        import("file = \"g.asc\"\nholes = \"dig\"\n").contains("import.holes = \"dig\": expected \"refuse\"")
    );
    let damaged = load("t.toml", "name = \"i\"\n[import]\nfile = \"g.asc\"\n", &mut |file, import| {
        mapless_heights::read(file, b"ncols 1", import)
    });
    assert!(damaged.unwrap_err().to_string().starts_with("g.asc: not a valid ESRI ASCII grid file"));
}

#[test]
fn holes_become_what_the_recipe_says() {
    let asc = b"ncols 3\nnrows 3\ncellsize 2\n-9999 1 1\n1 1 1\n1 1 1\n";
    let with = |lines: &str| {
        let text = format!("name = \"i\"\nbase_m = 4\n[import]\nfile = \"g.asc\"\n{lines}");
        load("t.toml", &text, &mut |file, import| mapless_heights::read(file, asc, import))
    };
    let refused =
        "g.asc: line 4, row 1, column 1 = -9999: expected a height in metres; 1 of 9 samples is a hole";
    for lines in ["", "holes = \"refuse\"\n"] {
        let message = with(lines).unwrap_err().to_string();
        assert!(message.starts_with(refused), "{message}");
    }
    let filled = with("holes = \"fill\"\n").unwrap();
    assert_eq!(filled.field.heights_m(), [5.0; 9]);
    assert_eq!(filled.warnings, ["g.asc: 1 of 9 samples was a hole: filled from the heights around"]);
    let cropped = with("holes = \"crop\"\n").unwrap();
    assert_eq!((cropped.field.columns(), cropped.field.rows()), (2, 3));
}

#[test]
fn a_recipe_says_what_it_imports_without_the_file() {
    assert_eq!(import_of("t.toml", LEVEL), Ok(None));
    let text = "name = \"i\"\n[import]\nfile = \"g.png\"\ncell_m = 2\nheight_min_m = 1\nheight_max_m = 3\nholes = \"crop\"\n";
    let import = mapless_heights::Import { cell_m: Some(2.0), range_m: Some((1.0, 3.0)), holes: Holes::Crop };
    assert_eq!(import_of("t.toml", text), Ok(Some(Imported { file: "g.png".to_owned(), import })));
    let fault = import_of("t.toml", "name = \"i\"\n[import]\nfile = \"/g.png\"\n").unwrap_err();
    assert!(fault.to_string().starts_with("t.toml: import.file = \"/g.png\""), "{fault}");
}

proptest! {
    #[test]
    fn mutations_never_panic(at in 0..340usize, byte in any::<u8>()) {
        let text = "name='m'\nsize_m=[8,8]\ncell_m=1\nseed=3\ntilt=[0.1,0]\n[[hill]]\ncentre=[2,2]\nheight_m=1\nradius_m=2\n\
            [[crater]]\ncentre=[5,5]\nradius_m=2\ndepth_m=1\nrim_height_m=0.1\n[[ridge]]\npoints=[[1,1],[4,5],[7,1]]\n\
            height_m=[1,2,1]\nwidth_m=1\n[[noise]]\namplitude_m=0.2\nwavelength_m=4\noctaves=2\n[[plateau]]\ncentre=[1,7]\n\
            height_m=1\ntop_radius_m=1\nflank_m=1\n[[trail]]\npoints=[[0,0],[8,8]]\nwidth_m=1\nshoulder_m=1\n";
        let mut bytes = text.as_bytes().to_vec();
        prop_assert!(build(text).is_ok());
        let at = at.min(bytes.len() - 1);
        bytes[at] = byte;
        if let Ok(text) = std::str::from_utf8(&bytes) {
            drop(build(text));
        }
    }
}

#[test]
fn strokes_repeat_what_was_done_by_hand() {
    let recipe = "name = \"a\"\nsize_m = [20.0, 10.0]\ncell_m = 0.25\n\n[[hill]]\ncentre = [9.0, 5.0]\nheight_m = 2.0\nradius_m = 2.0\n";
    let keys = "kind = \"raise\"\nradius_m = 2.0\nstrength_m = 0.3\npoints = [[5.0, 5.0], [5.5, 5.25]]\n";
    let load = |text: &str| load("a.toml", text, &mut |_, _| Err(Fault::Read { reason: "none".to_owned() }));
    let mut by_hand = load(recipe).unwrap().field;
    for brush in Stroke::parse(keys).unwrap().brushes() {
        by_hand.sculpt(brush).unwrap();
    }
    assert_eq!(load(&format!("{recipe}\n[[stroke]]\n{keys}")).unwrap().field, by_hand);
    let fault =
        load(&format!("{recipe}\n[[stroke]]\n{}", keys.replace("0.3", "-1"))).unwrap_err().to_string();
    assert_eq!(
        fault,
        "a.toml: line 10, stroke[1].points[1], strength_m = -1: expected a number from 0 to 100"
    );
}

#[test]
fn strokes_without_end_are_refused() {
    let side = "name = \"a\"\nsize_m = [500.0, 500.0]\ncell_m = 0.5\n";
    let points = vec!["[250.0, 250.0]"; 251].join(", ");
    let keys = format!("kind = \"lower\"\nradius_m = 900.0\nstrength_m = 0.0\npoints = [{points}]\n");
    let fault = build(&format!("{side}[[stroke]]\n{keys}")).unwrap_err().to_string();
    let expected =
        "test.toml: line 4, stroke[1].samples touched = 252504252: expected at most 250000000 in all tables";
    assert_eq!(fault, expected);
}

#[test]
fn features_without_end_are_refused() {
    let side = "name = \"a\"\nsize_m = [800.0, 800.0]\ncell_m = 0.2\n";
    let hill = "[[hill]]\ncentre = [1, 1]\nheight_m = 0\nradius_m = 1000\n";
    let fault = build(&format!("{side}{}", hill.repeat(8000))).unwrap_err().to_string();
    let expected =
        "test.toml: line 60, hill[15].samples touched = 256128016: expected at most 250000000 in all tables";
    assert_eq!(fault, expected);
}

#[test]
fn lines_without_end_are_refused() {
    let points = vec!["[0, 0], [800, 800]"; 25_000].join(", ");
    let side = "name = \"a\"\nsize_m = [800.0, 800.0]\ncell_m = 0.2\n";
    for keys in ["ridge]]\nheight_m = 0\nwidth_m = 1", "trail]]\nshoulder_m = 1\nwidth_m = 1"] {
        let fault = build(&format!("{side}[[{keys}\npoints = [{points}]\n")).unwrap_err().to_string();
        assert!(fault.contains("[1].samples touched = ") && fault.contains("at most 250000000"), "{fault}");
    }
}

/// Real recipes stay far from the limit.
#[test]
fn shipped_and_generated_terrains_touch_few_samples() {
    let effort = |text: &str| {
        let recipe: Recipe = mapless_toml::from_str(text).unwrap();
        let mut canvas =
            recipe.ground("", &mut |_, _| Err(Fault::Read { reason: "none".to_owned() })).unwrap().0;
        recipe.shape(text, &mut canvas).unwrap();
        canvas.effort.samples
    };
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../terrains");
    let mut texts = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            texts.push(std::fs::read_to_string(path).unwrap());
        }
    }
    assert!(texts.len() >= 5);
    for family in Family::ALL {
        texts.extend((0..4).map(|seed| terrain_recipe("a", family, seed)));
    }
    for text in texts {
        let samples = effort(&text);
        println!("{samples}");
        assert!(samples < MAX_TOUCHED_SAMPLES / 10, "{samples}: {text}");
    }
}
