//! A small line plot as SVG, on a white sheet of its own, so that it is readable in print and on a dark page.

use std::fmt::Write as _;

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 168.0;
const TOP: f64 = 16.0;
const BOTTOM: f64 = 52.0;
/// Labels of neighbouring lines keep this distance.
const LABEL_HEIGHT: f64 = 15.0;
/// Okabe and Ito's colours for everybody, but for black, which is the text's, and yellow, which a white sheet
/// hides, with two more.
pub const COLOURS: [&str; 8] =
    ["#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6bb1", "#888888"];

/// One line.
pub struct Line {
    /// Stands at its end.
    pub name: String,
    /// Places of x and y, joined in order.
    pub points: Vec<(f64, f64)>,
}

/// How the values of both axes are spaced.
#[derive(Clone, Copy, PartialEq)]
pub enum Scale {
    /// Evenly; the vertical axis includes zero.
    Linear,
    /// By their logarithms; all of them must be positive.
    Logarithmic,
}

/// Lines over one axis.
pub struct Plot {
    /// What x is, and its unit.
    pub x_label: String,
    /// What y is, and its unit.
    pub y_label: String,
    /// The lines.
    pub lines: Vec<Line>,
    /// A value of x to mark.
    pub mark_x: Option<f64>,
    /// Of both axes.
    pub scale: Scale,
}

impl Plot {
    /// Draws it.
    pub fn svg(&self) -> String {
        let place = |value: f64| match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => libm::log10(value),
        };
        let all = || self.lines.iter().flat_map(|line| line.points.iter().copied());
        let zero = (self.scale == Scale::Linear).then_some(0.0);
        let (x_low, x_high) = range(all().map(|(x, _)| place(x)));
        let (x_low, x_high) = widened(x_low, x_high);
        let (y_low, y_high) = range(all().map(|(_, y)| place(y)).chain(zero));
        let (y_low, y_high) = widened(y_low, y_high);
        let step = |span: f64| match self.scale {
            Scale::Linear => step(span),
            Scale::Logarithmic => 1.0,
        };
        let y_step = step(y_high - y_low);
        let (y_low, y_high) = widened((y_low / y_step).floor() * y_step, (y_high / y_step).ceil() * y_step);
        let x_at = |x: f64| LEFT + (place(x) - x_low) / (x_high - x_low) * (WIDTH - LEFT - RIGHT);
        let y_at = |y: f64| HEIGHT - BOTTOM - (place(y) - y_low) / (y_high - y_low) * (HEIGHT - TOP - BOTTOM);
        let value_at = |tick: f64| match self.scale {
            Scale::Linear => tick,
            Scale::Logarithmic => libm::exp10(tick),
        };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"system-ui, sans-serif\" font-size=\"13\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/><style>text {{ fill: #333 }} .axis {{ stroke: #999 }}</style>\n"
        );
        let mut draw = |text: String| {
            let _ = writeln!(svg, "{text}");
        };
        for (value, y) in ticks(y_low, y_high, y_step).map(value_at).map(|v| (v, y_at(v))) {
            let width = if value.abs() < 1e-9 { 1.5 } else { 0.5 };
            draw(format!(
                "<path class=\"axis\" d=\"M{LEFT} {y:.1}H{}\" stroke-width=\"{width}\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                WIDTH - RIGHT,
                LEFT - 8.0,
                y + 4.0,
                number(value)
            ));
        }
        let x_step = step(x_high - x_low);
        for value in ticks((x_low / x_step).ceil() * x_step, x_high, x_step).map(value_at) {
            draw(format!(
                "<text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                x_at(value),
                HEIGHT - BOTTOM + 20.0,
                number(value)
            ));
        }
        if let Some(x) = self.mark_x.map(x_at) {
            draw(format!(
                "<path class=\"axis\" d=\"M{x:.1} {TOP}V{}\" stroke-dasharray=\"4 4\"/>",
                HEIGHT - BOTTOM
            ));
        }
        for (line, colour) in self.lines.iter().zip(COLOURS.iter().cycle()) {
            let points: Vec<String> =
                line.points.iter().map(|&(x, y)| format!("{:.1},{:.1}", x_at(x), y_at(y))).collect();
            draw(format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2.5\" stroke-linejoin=\"round\"/>",
                points.join(" ")
            ));
        }
        let mut labels: Vec<(f64, f64, &str, &str)> = (self.lines.iter().zip(COLOURS.iter().cycle()))
            .filter_map(|(line, colour)| {
                let &(x, y) = line.points.last()?;
                Some((y_at(y) + 4.0, x_at(x) + 8.0, line.name.as_str(), *colour))
            })
            .collect();
        labels.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut free_from = f64::NEG_INFINITY;
        for (y, x, name, colour) in labels {
            let y = y.max(free_from);
            free_from = y + LABEL_HEIGHT;
            // The stroke says whose label it is where lines end at one place.
            draw(format!(
                "<path stroke=\"{colour}\" stroke-width=\"2.5\" d=\"M{x:.1} {:.1}h12\"/><text x=\"{:.1}\" y=\"{y:.1}\">{name}</text>",
                y - 4.0,
                x + 16.0
            ));
        }
        draw(format!(
            "<text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            (LEFT + WIDTH - RIGHT) / 2.0,
            HEIGHT - 10.0,
            self.x_label
        ));
        draw(format!(
            "<text transform=\"translate(16 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n</svg>",
            (TOP + HEIGHT - BOTTOM) / 2.0,
            self.y_label
        ));
        svg
    }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

/// A single value has a range around it, so that it has a place.
fn widened(low: f64, high: f64) -> (f64, f64) {
    if high > low { (low, high) } else { (low - 0.5, high + 0.5) }
}

/// A round distance between ticks, for about six of them.
fn step(span: f64) -> f64 {
    let rough = (span / 6.0).max(f64::MIN_POSITIVE);
    let power = libm::pow(10.0, libm::log10(rough).floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|s| *s >= rough).unwrap_or(rough)
}

fn ticks(from: f64, to: f64, step: f64) -> impl Iterator<Item = f64> {
    let count = ((to - from) / step + 1e-9) as usize;
    (0..=count).map(move |k| from + k as f64 * step)
}

fn number(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert!((step(0.16) - 0.05).abs() < 1e-12 && (step(5.9) - 1.0).abs() < 1e-12);
        let ticks: Vec<String> = ticks(-0.2, 0.6, 0.2).map(number).collect();
        assert_eq!(ticks, ["-0.2", "0", "0.2", "0.4", "0.6"]);
    }

    #[test]
    fn a_plot_has_its_lines_and_labels() {
        let line = Line { name: "error".to_owned(), points: vec![(0.2, 1.0), (0.3, 0.5)] };
        let svg = Plot {
            x_label: "x".to_owned(),
            y_label: "y".to_owned(),
            lines: vec![line],
            mark_x: Some(0.25),
            scale: Scale::Linear,
        }
        .svg();
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
        assert!(svg.contains(">error</text>") && svg.contains("polyline") && !svg.contains("NaN"));
    }

    #[test]
    fn a_level_line_and_a_single_point_have_a_place() {
        for points in [vec![(0.0, 0.0), (1.0, 0.0)], vec![(2.0, 3.0)]] {
            let line = Line { name: "roll".to_owned(), points };
            let (x_label, y_label) = ("s".to_owned(), "rad".to_owned());
            let svg = Plot { x_label, y_label, lines: vec![line], mark_x: None, scale: Scale::Linear }.svg();
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
    }

    #[test]
    fn decades_are_evenly_spaced_on_a_logarithmic_plot() {
        let line = Line { name: "cost".to_owned(), points: vec![(10.0, 0.1), (100.0, 1.0), (1000.0, 10.0)] };
        let plot = Plot {
            x_label: "n".to_owned(),
            y_label: "ms".to_owned(),
            lines: vec![line],
            mark_x: None,
            scale: Scale::Logarithmic,
        };
        let svg = plot.svg();
        let points = svg.split_once("points=\"").unwrap().1.split_once('"').unwrap().0;
        let xs: Vec<f64> = points.split([' ', ',']).step_by(2).map(|x| x.parse().unwrap()).collect();
        assert!((xs[0] + xs[2] - 2.0 * xs[1]).abs() < 0.2, "{points}");
        for label in [">0.1<", ">10<", ">1000<"] {
            assert!(svg.contains(label), "{label}\n{svg}");
        }
    }
}
