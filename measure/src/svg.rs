//! Charts as SVG text: panels with axes, lines and points, and a legend. Colours are those of Okabe and Ito, which people
//! with any colour vision can tell apart; lines differ in dashes too where they would lie close.

use crate::File;
use std::fmt::Write;

/// The colours of Okabe and Ito, darkest first where it matters.
pub const COLOURS: [&str; 8] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#7f7f7f"];

const FONT: &str = "Helvetica, Arial, 'DejaVu Sans', sans-serif";
const SIZE: f64 = 13.0;
const BOLD: &str = " font-weight=\"bold\"";
/// What stands between a label and the edge.
const EDGE: f64 = 8.0;
const INK: &str = "#222222";
const GRID: &str = "#e3e3e3";

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// A line.
    Solid,
    /// A line of dashes, thin.
    Dashed,
    /// A line with a dot at each point.
    Dotted,
    /// Dots alone.
    Dots,
    /// A line of steps: the value holds until the next point.
    Steps,
}

/// What is drawn in one colour.
#[derive(Clone, Debug)]
pub struct Series {
    /// An index into [`COLOURS`].
    pub colour: usize,
    /// How.
    pub stroke: Stroke,
    /// Where.
    pub points: Vec<(f64, f64)>,
}

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it measures.
    pub label: String,
    /// Its first value.
    pub low: f64,
    /// Its last value.
    pub high: f64,
    /// Whether it is logarithmic.
    pub logarithmic: bool,
    /// Where it has a line, and what is written there.
    pub ticks: Vec<(f64, String)>,
}

impl Axis {
    /// A logarithmic axis with a tick at each power of ten.
    pub fn decades(label: &str, low: f64, high: f64) -> Self {
        let exponents = low.log10().ceil() as i32..=high.log10().floor() as i32;
        let ticks = exponents.map(|e| (10f64.powi(e), power_of_ten(e))).collect();
        Self { label: label.to_owned(), low, high, logarithmic: true, ticks }
    }

    /// A logarithmic axis with ticks at given values.
    pub fn logarithmic(label: &str, low: f64, high: f64, ticks: &[f64]) -> Self {
        Self { logarithmic: true, ..Self::linear(label, low, high, ticks) }
    }

    /// An even axis with ticks at given values.
    pub fn linear(label: &str, low: f64, high: f64, ticks: &[f64]) -> Self {
        let ticks = ticks.iter().map(|value| (*value, value.to_string())).collect();
        Self { label: label.to_owned(), low, high, logarithmic: false, ticks }
    }

    /// Where a value lies, 0 at the first and 1 at the last.
    fn place(&self, value: f64) -> f64 {
        match self.logarithmic {
            true => (value / self.low).ln() / (self.high / self.low).ln(),
            false => (value - self.low) / (self.high - self.low),
        }
    }
}

/// A power of ten with a raised exponent.
fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => {
            let raise = |c: char| match c {
                '-' => '⁻',
                '1' => '¹',
                '2' => '²',
                '3' => '³',
                digit => char::from_u32(0x2070 + u32::from(digit) - u32::from('0')).unwrap_or(digit),
            };
            format!("10{}", exponent.to_string().chars().map(raise).collect::<String>())
        }
    }
}

/// A chart of its own axes.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, the first lowest.
    pub series: Vec<Series>,
}

/// An entry of the legend.
#[derive(Clone, Debug)]
pub struct Key {
    /// What it means.
    pub label: String,
    /// An index into [`COLOURS`].
    pub colour: usize,
    /// How it is drawn.
    pub stroke: Stroke,
}

/// A picture: panels in rows, a legend to their right. It is as large as its labels need.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What it shows.
    pub title: String,
    /// A line below the title.
    pub subtitle: String,
    /// Its size without the legend.
    pub size: [f64; 2],
    /// How many panels stand side by side.
    pub columns: usize,
    /// The panels.
    pub panels: Vec<Panel>,
    /// The legend.
    pub keys: Vec<Key>,
}

/// A rectangle: left, top, width, height.
#[derive(Clone, Copy)]
struct Frame([f64; 4]);

impl Frame {
    fn at(&self, panel: &Panel, (x, y): (f64, f64)) -> (f64, f64) {
        let [left, top, width, height] = self.0;
        (left + width * panel.x.place(x), top + height * (1.0 - panel.y.place(y)))
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// At most how wide words are, in any font of [`FONT`].
fn width(words: &str, size: f64) -> f64 {
    let of = |c: char| match c {
        'i' | 'j' | 'l' | 'f' | 't' | 'r' | ' ' | ',' | '.' | ':' | ';' | '(' | ')' => 0.42,
        'm' | 'w' | '−' | '≤' => 1.0,
        c if c.is_uppercase() => 0.99,
        _ => 0.66,
    };
    words.chars().map(of).sum::<f64>() * size
}

/// What is drawn, and the rectangle that it fills: left, top, right, bottom.
struct Canvas {
    out: String,
    filled: [f64; 4],
}

/// Which point of a label its place is.
#[derive(Clone, Copy, PartialEq)]
enum Anchor {
    Start,
    Middle,
    End,
    /// The middle of a label that is turned and reads upwards.
    Upwards,
}

impl Canvas {
    fn text(&mut self, (x, y): (f64, f64), anchor: Anchor, (size, attributes): (f64, &str), words: &str) {
        if words.is_empty() {
            return;
        }
        let long = width(words, size);
        let (before, turn) = match anchor {
            Anchor::Start => (0.0, String::new()),
            Anchor::Middle => (long / 2.0, " text-anchor=\"middle\"".to_owned()),
            Anchor::End => (long, " text-anchor=\"end\"".to_owned()),
            Anchor::Upwards => (long / 2.0, format!(" text-anchor=\"middle\" transform=\"rotate(-90 {x:.1} {y:.1})\"")),
        };
        let [left, top, right, bottom] = match anchor {
            Anchor::Upwards => [x - size, y - before, x + size, y + before],
            _ => [x - before, y - size, x - before + long, y + size],
        };
        let [l, t, r, b] = self.filled;
        self.filled = [l.min(left - EDGE), t.min(top - EDGE), r.max(right + EDGE), b.max(bottom + EDGE)];
        let _ = writeln!(
            self.out,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\"{turn}{attributes}>{}</text>",
            escaped(words)
        );
    }
}

fn line(out: &mut String, (x1, y1): (f64, f64), (x2, y2): (f64, f64), colour: &str, width: f64) {
    let _ = writeln!(
        out,
        "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
    );
}

fn stroke(out: &mut String, points: &[(f64, f64)], colour: usize, stroke: Stroke) {
    let colour = COLOURS[colour % COLOURS.len()];
    let place = |(x, y): &(f64, f64)| format!("{x:.1},{y:.1}");
    let path: Vec<String> = match stroke {
        Stroke::Steps => points
            .iter()
            .zip(points.iter().skip(1).map(Some).chain([None]))
            .flat_map(|(a, b)| [place(a), b.map_or_else(|| place(a), |b| place(&(b.0, a.1)))])
            .collect(),
        _ => points.iter().map(place).collect(),
    };
    let dashes = match stroke {
        Stroke::Dots => None,
        Stroke::Dashed => Some("stroke-width=\"1.2\" stroke-dasharray=\"5 4\""),
        _ => Some("stroke-width=\"2.2\""),
    };
    if let Some(dashes) = dashes {
        let _ = writeln!(
            out,
            "<polyline fill=\"none\" stroke=\"{colour}\" stroke-linejoin=\"round\" {dashes} points=\"{}\"/>",
            path.join(" ")
        );
    }
    if matches!(stroke, Stroke::Dotted | Stroke::Dots) {
        for (x, y) in points {
            let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.2\" fill=\"{colour}\"/>");
        }
    }
}

impl Panel {
    fn draw(&self, canvas: &mut Canvas, frame: Frame, place: usize) {
        let [left, top, width, height] = frame.0;
        canvas.text((left + width / 2.0, top - 9.0), Anchor::Middle, (SIZE, BOLD), &self.title);
        for (value, label) in &self.x.ticks {
            let (x, _) = frame.at(self, (*value, self.y.low));
            line(&mut canvas.out, (x, top), (x, top + height), GRID, 1.0);
            canvas.text((x, top + height + 17.0), Anchor::Middle, (SIZE, ""), label);
        }
        for (value, label) in &self.y.ticks {
            let (_, y) = frame.at(self, (self.x.low, *value));
            line(&mut canvas.out, (left, y), (left + width, y), GRID, 1.0);
            canvas.text((left - 7.0, y + 4.0), Anchor::End, (SIZE, ""), label);
        }
        let out = &mut canvas.out;
        let _ = writeln!(
            out,
            "<clipPath id=\"panel{place}\"><rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" \
             height=\"{height:.1}\"/></clipPath>\n<g clip-path=\"url(#panel{place})\">"
        );
        for series in &self.series {
            let inside = |(_, y): &&(f64, f64)| y.is_finite() && !(self.y.logarithmic && *y <= 0.0);
            let points: Vec<_> = series.points.iter().filter(inside).map(|point| frame.at(self, *point)).collect();
            stroke(out, &points, series.colour, series.stroke);
        }
        let _ = writeln!(
            out,
            "</g>\n<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"none\" \
             stroke=\"{INK}\"/>"
        );
        canvas.text((left + width / 2.0, top + height + 38.0), Anchor::Middle, (SIZE, ""), &self.x.label);
        canvas.text((left - 48.0, top + height / 2.0), Anchor::Upwards, (SIZE, ""), &self.y.label);
    }
}

impl Picture {
    /// The text of the file.
    pub fn svg(&self) -> String {
        let [width, height] = self.size;
        let mut canvas = Canvas { out: String::new(), filled: [0.0, 0.0, width, height] };
        canvas.text((20.0, 28.0), Anchor::Start, (18.0, BOLD), &self.title);
        canvas.text((20.0, 49.0), Anchor::Start, (SIZE, " fill=\"#555555\""), &self.subtitle);
        let rows = self.panels.len().div_ceil(self.columns);
        let (across, down) = (width / self.columns as f64, (height - 60.0) / rows as f64);
        for (place, panel) in self.panels.iter().enumerate() {
            let (column, row) = (place % self.columns, place / self.columns);
            let (left, top) = (across * column as f64 + 68.0, 60.0 + down * row as f64 + 28.0);
            panel.draw(&mut canvas, Frame([left, top, across - 86.0, down - 80.0]), place);
        }
        for (place, key) in self.keys.iter().enumerate() {
            let (x, y) = (width + 8.0, 98.0 + 24.0 * place as f64);
            let ends = match key.stroke {
                Stroke::Dots => vec![(x + 15.0, y)],
                Stroke::Dotted => vec![(x + 2.0, y), (x + 28.0, y)],
                _ => vec![(x, y), (x + 30.0, y)],
            };
            let solid = if key.stroke == Stroke::Steps { Stroke::Solid } else { key.stroke };
            stroke(&mut canvas.out, &ends, key.colour, solid);
            canvas.text((x + 38.0, y + 4.5), Anchor::Start, (SIZE, ""), &key.label);
        }
        let [left, top, right, bottom] = canvas.filled.map(f64::round);
        let (width, height) = (right - left, bottom - top);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"{left} {top} {width} \
             {height}\" font-family=\"{FONT}\" fill=\"{INK}\" role=\"img\">\n<title>{}</title>\n\
             <rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            escaped(&self.title),
            canvas.out
        )
    }
}

/// An entry of a legend.
pub(crate) fn key(label: &str, colour: usize, stroke: Stroke) -> Key {
    Key { label: label.to_owned(), colour, stroke }
}

/// The file of a picture.
pub(crate) fn file(name: &str, picture: &Picture) -> File {
    File { name: format!("{name}.svg"), text: picture.svg() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_as_large_as_its_labels() {
        let axis = |label: &str| Axis::linear(label, 0.0, 1.0, &[0.0, 1.0]);
        let long = "m".repeat(200);
        let seen = |title: &str, y: &str, label: &str| {
            let panel = Panel { title: String::new(), x: axis("x"), y: axis(y), series: vec![] };
            let picture = Picture {
                title: title.to_owned(),
                subtitle: String::new(),
                size: [400.0, 300.0],
                columns: 1,
                panels: vec![panel],
                keys: vec![Key { label: label.to_owned(), colour: 0, stroke: Stroke::Solid }],
            };
            let svg = picture.svg();
            let (_, view) = svg.split_once("viewBox=\"").unwrap();
            let view: Vec<f64> = view.split_once('"').unwrap().0.split(' ').map(|x| x.parse().unwrap()).collect();
            <[f64; 4]>::try_from(view).unwrap()
        };
        let [_, _, width, height] = seen("title", "y", "key");
        assert!(width < 600.0 && height < 400.0);
        assert!(seen(&long, "y", "key")[2] > 200.0 * 18.0);
        assert!(seen("title", "y", &long)[2] > 400.0 + 200.0 * SIZE);
        let [_, top, _, height] = seen("title", &long, "key");
        assert!(top < 0.0 && height > 200.0 * SIZE);
    }

    #[test]
    fn powers_are_raised_and_axes_place_their_ends() {
        assert_eq!(power_of_ten(-4), "10⁻⁴");
        assert_eq!(power_of_ten(12), "10¹²");
        let axis = Axis::decades("", 1e-3, 10.0);
        assert_eq!(axis.ticks.len(), 5);
        assert!(axis.place(1e-3).abs() < 1e-12 && (axis.place(10.0) - 1.0).abs() < 1e-12);
        assert!((axis.place(0.1) - 0.5).abs() < 1e-12);
    }
}
