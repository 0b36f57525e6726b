//! `docs/BANDS.md` and its picture: what shading from tables of a light's bands costs and errs by, beside the ways that read
//! none.

use crate::bands::Tables;
use crate::canvas::{BRIGHT, Canvas, GROUND, MUTED, Text, difference, shown};
use crate::figures::{Errors, Inputs, drawn, percent, pixel_errors};
use crate::frame::Frame;
use crate::gpu::{Gpu, Stage};
use crate::subject::Subject;
use crate::tone;
use indicatif::ProgressBar;
use std::fmt::Write;
use zonal_codegen::environment::bands::bound_side;
use zonal_codegen::environment::{Projection, Texel};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_picture::method::{Judged, Method, Reading};

/// The orders of the tables.
pub const ORDERS: [usize; 5] = [3, 5, 6, 8, 10];
/// The orders that are drawn.
pub const DRAWN: [usize; 3] = [3, 5, 8];
/// The errors that tables are made for.
pub const ERRORS: [f64; 3] = [0.1, 0.01, 0.001];
/// The bands whose sides are told.
const BANDS: [usize; 7] = [0, 1, 2, 3, 4, 6, 9];
/// The side that both papers take for every band.
pub const PAPERS: usize = 1024;
/// The size of the pictures that are measured.
const SIZE: [usize; 2] = [220, 180];

/// A picture's errors against the exact kernel's.
#[derive(Clone, Debug)]
pub struct Row {
    /// The number of bands.
    pub order: usize,
    /// The error that the tables were made for.
    pub asked: f64,
    /// Bytes of the tables, three halves a texel.
    pub bytes: usize,
    /// The errors of the signal-tailored rotation, then of isotropic decomposition.
    pub errors: [Errors; 2],
}

/// A band's table.
#[derive(Clone, Debug)]
pub struct Side {
    /// The band.
    pub band: usize,
    /// For each error the side of its faces, and what is measured.
    pub sides: Vec<(usize, f64)>,
    /// What is measured with the papers' side.
    pub papers: f64,
}

impl Row {
    /// Returns its line in the page's table.
    pub fn line(&self) -> String {
        let [zhf, isd] = self.errors.map(|errors| format!("{} | {}", percent(errors.rms), percent(errors.worst)));
        format!("| {} | {} | {} | {zhf} | {isd} |\n", self.order, percent(self.asked), thousands(self.bytes))
    }
}

impl Side {
    /// Returns its line in the page's table.
    pub fn line(&self) -> String {
        let mut line = format!("| {} |", self.band);
        for ((texels, error), asked) in self.sides.iter().zip(ERRORS) {
            let _ = write!(line, " {texels} ({}) | {} |", percent(*error), bound_side(self.band, asked));
        }
        line + &format!(" {} |\n", percent(self.papers))
    }
}

/// What is measured.
pub struct Report {
    /// The subject's name and its map's.
    pub scene: String,
    /// By band.
    pub sides: Vec<Side>,
    /// By order and error.
    pub rows: Vec<Row>,
    canvas: Canvas,
}

/// The methods that read tables.
const METHODS: [Method; 2] = [Method::ZhfTailored, Method::IsdTables];

/// The pictures of both methods from tables of an error, against the exact one.
fn row(stage: &Stage, inputs: &Inputs, exact: &Frame, asked: f64) -> Result<(Row, [Frame; 2]), Diagnostic> {
    let order = inputs.light.order;
    let tables = Tables::new(&inputs.light, asked)?;
    let draw = |method: Method| {
        let (shading, table) = (stage.subject.shading(order, method), tables.reflectance(&inputs.tables[0], method));
        stage.frame(shading, &table, &inputs.light, Some(&tables), false)
    };
    let frames = [draw(METHODS[0])?, draw(METHODS[1])?];
    let errors = frames.each_ref().map(|frame| Errors::of(frame, exact));
    Ok((Row { order, asked, bytes: tables.bytes(), errors }, frames))
}

/// Returns the rows of some orders, every error each.
///
/// # Errors
///
/// If the device fails.
pub fn rows(gpu: &Gpu, subject: &Subject, orders: &[usize], bar: &ProgressBar) -> Result<Vec<Row>, Diagnostic> {
    let stage = Stage::new(gpu, subject, SIZE)?;
    let mut rows = Vec::new();
    for &order in orders {
        bar.set_message(format!("order {order}"));
        let inputs = Inputs::new(subject, order);
        let (exact, _) = drawn(&stage, &inputs, Method::Exact, None, false)?;
        for asked in ERRORS {
            rows.push(row(&stage, &inputs, &exact, asked)?.0);
            bar.inc(1);
        }
    }
    Ok(rows)
}

/// Returns the sides of some bands of a light.
///
/// # Errors
///
/// If a table cannot be made.
pub fn sides(light: &Projection, bands: &[usize]) -> Result<Vec<Side>, Diagnostic> {
    let side = |&band: &usize| {
        let of = |&error: &f64| {
            light.band_table(band, error, Texel::Half).map(|table| (table.side, table.error, table.largest))
        };
        let found = ERRORS.iter().map(of).collect::<Result<Vec<_>, _>>();
        let found = found.map_err(|fault| Diagnostic::nowhere(fault.message, fault.help))?;
        let largest = found[0].2;
        let papers = light.read_error(band, PAPERS, Texel::Half, largest);
        Ok(Side { band, sides: found.iter().map(|&(side, error, _)| (side, error)).collect(), papers })
    };
    bands.iter().map(side).collect()
}

/// Operations for three channels, reads, values that live at once where they are counted.
struct Form {
    name: String,
    operations: usize,
    reads: usize,
    live: Option<usize>,
}

/// The ways to shade at an order.
fn forms(order: usize) -> Vec<Form> {
    let kernel = |name: &str, text: &str, channels: usize, besides: usize| -> Option<Form> {
        let spec: Spec = text.parse().ok()?;
        let listing = Listing::new(&spec.kernel());
        let operations = listing.cost(channels).total + besides;
        Some(Form { name: name.to_owned(), operations, reads: 0, live: Some(listing.footprint().live) })
    };
    let turned =
        kernel("`rotate` the reflectance, then times the light", &format!("rotate:{order}"), 1, 3 * order * order);
    let reading = |name: &str, method: Method| {
        let Reading { operations, reads } = Reading::of(method, order)?;
        Some(Form { name: name.to_owned(), operations, reads, live: None })
    };
    let all = [
        turned,
        kernel("`shade`, the direct form", &format!("shade:{order}:rgb"), 3, 0),
        kernel("`isd_shade`, equation 22 on the fly", &format!("isd_shade:{order}:rgb"), 3, 0),
        reading("`isd_tables`, equation 22 from tables", Method::IsdTables),
        reading("`zhf_tailored` from tables, then times the reflectance", Method::ZhfTailored),
    ];
    all.into_iter().flatten().collect()
}

fn thousands(bytes: usize) -> String {
    match bytes {
        bytes if bytes >= 10_000_000 => format!("{:.0} MB", bytes as f64 / 1e6),
        bytes => format!("{:.1} kB", bytes as f64 / 1e3),
    }
}

impl Report {
    /// Measures a subject.
    ///
    /// # Errors
    ///
    /// If the device fails or a table cannot be made.
    pub fn measure(gpu: &Gpu, subject: &Subject, bar: &ProgressBar) -> Result<Self, Diagnostic> {
        bar.set_length((DRAWN.len() * ERRORS.len() + 2) as u64);
        bar.set_message("sides");
        let most = BANDS.iter().max().map_or(1, |band| band + 1);
        let sides = sides(&subject.light(most), &BANDS)?;
        bar.inc(1);
        let rows = rows(gpu, subject, &DRAWN, bar)?;
        let canvas = canvas(gpu, subject)?;
        Ok(Self { scene: subject.name.clone(), sides, rows, canvas })
    }

    /// The picture.
    pub fn canvas(&self) -> &Canvas {
        &self.canvas
    }

    /// The page.
    pub fn markdown(&self) -> String {
        let mut text = format!(
            "# Shading from tables of bands, measured\n\n\
             <!-- @generated by zonal: cargo render page bands -->\n\n\
             ![A teapot, exactly, by the signal-tailored rotation and by isotropic decomposition, both from tables, with their errors](bands.png)\n\n\
             The picture of `scenes/{}.toml` (exact, then `method = \"zhf_tailored\"` and `method = \"isd_tables\"` with their \
             errors in false colours, yellow at 1 % of the mean radiance). `zonal bands MAP --order n` writes the bands f_l(ω) \
             of a light, each as a cubemap, and the WGSL and GLSL that read them: at the lobes of the signal-tailored rotation \
             (Nowrouzezahrai et al. 2012, equation 11), whose samples `zhf_tailored` makes into coefficients, and at the \
             directions of isotropic decomposition (Soler et al. 2015, equation 22, the middle line).\n\n\
             ## The sides of the faces\n\n\
             The smallest faces with which a bilinear read errs by no more than is asked for, as a share of the band's largest \
             value; in brackets what is measured, in the middles of 20,000 cells and of two of their sides. *By the bound* is \
             l² h² / 4 of it for texels h apart: it is one of the second order, which the curves of a face's coordinates may \
             exceed where h is large. Texels are halves, which round by 0.05 % at most. The texels of a face's rim lie on the cube's edge, where the neighbour has the same ones: no filter reaches \
             over an edge. Beside them faces of {PAPERS} texels for every band, as both papers have them: there rounding is all \
             that is left.\n\n| band |",
            self.scene
        );
        for error in ERRORS {
            let _ = write!(text, " {} | by the bound |", percent(error));
        }
        let _ = write!(text, " {PAPERS} texels |\n|---|{}---|\n", "---|---|".repeat(ERRORS.len()));
        text.extend(self.sides.iter().map(Side::line));
        self.write_pictures(&mut text);
        text + &forms_text()
    }

    fn write_pictures(&self, text: &mut String) {
        let _ = write!(
            text,
            "\n## What a picture errs by\n\n\
             Against the exact kernel's picture, as shares of the mean radiance: the root mean square and the worst pixel. Bands \
             are read with errors of their own, most of which the sum over a band's reads and over the bands takes out. \
             *Tables* are bytes of three halves a texel, all bands together; faces of {PAPERS} texels for every band would take \
             {} at order 3, {} at order 5 and {} at order 8.\n\n\
             | order | error a read | tables | `zhf_tailored`: rms | worst | `isd_tables`: rms | worst |\n\
             |---|---|---|---|---|---|---|\n",
            thousands(3 * 36 * PAPERS * PAPERS),
            thousands(5 * 36 * PAPERS * PAPERS),
            thousands(8 * 36 * PAPERS * PAPERS)
        );
        text.extend(self.rows.iter().map(Row::line));
    }
}

/// Returns what the page says of operations.
pub fn forms_text() -> String {
    let mut text = String::new();
    let _ = write!(
        text,
        "\n## Which pays when\n\n\
         Operations for R, G and B, from the quaternion of the frame and the reflectance's n² numbers for the view (coefficients, or \
         weights that `isd_weights` makes of them) to the radiance. A read's own operations, 3 to keep it within its face and for \
         each direction 8, are among them; its filtering is not. *Live* are the values of one channel that live at once, which is \
         what registers hold besides the inputs; of what reads tables it hangs on how many reads a compiler keeps under way. *A read \
         may cost* so many operations before the best of the ways without tables is cheaper.\n\n\
         The reflectance is one number where light is three: to turn it is cheaper than to turn the light, which is what the direct \
         form, equation 22 and both kinds of tables do. So tables pay only where a read costs next to nothing, or where the light \
         is grey, or where one turn serves many reflectances, as in the paper's transfer of light.\n\n\
         | order | way | operations | reads | live | a read may cost |\n|---|---|---|---|---|---|\n"
    );
    for order in ORDERS {
        let forms = forms(order);
        let best = forms.iter().filter(|form| form.reads == 0).map(|form| form.operations).min().unwrap_or(0);
        for form in forms {
            let live = form.live.map_or_else(|| "–".to_owned(), |live| live.to_string());
            let price = match form.reads {
                0 => "–".to_owned(),
                _ if form.operations >= best => "nothing".to_owned(),
                reads => format!("{:.1}", (best - form.operations) as f64 / reads as f64),
            };
            let _ =
                writeln!(text, "| {order} | {} | {} | {} | {live} | {price} |", form.name, form.operations, form.reads);
        }
    }
    let first = (3..=12).find(|&order| {
        let forms = forms(order);
        let best = forms.iter().filter(|form| form.reads == 0).map(|form| form.operations).min();
        forms.iter().any(|form| form.reads > 0 && Some(form.operations) < best)
    });
    let _ = match first {
        Some(order) => {
            writeln!(text, "\nThe first order at which a way with tables takes fewer operations is {order}.")
        }
        None => writeln!(text, "\nTo order 12 no way with tables takes fewer operations."),
    };
    let _ = writeln!(
        text,
        "The same forms for one channel, with the isotropic and the zonal ones, stand in \
         [measure/shading.md](measure/shading.md)."
    );
    text
}

/// The strip: exact, then each method and its errors.
fn canvas(gpu: &Gpu, subject: &Subject) -> Result<Canvas, Diagnostic> {
    const GAP: usize = 12;
    const TITLE: usize = 34;
    const LINE: usize = 24;
    const SAMPLES: usize = 2;
    let stage = Stage::new(gpu, subject, SIZE.map(|side| side * SAMPLES))?;
    let inputs = Inputs::new(subject, subject.order);
    let (exact, _) = drawn(&stage, &inputs, Method::Exact, None, false)?;
    let (row, frames) = row(&stage, &inputs, &exact, 0.01)?;
    let exposure = tone::exposure(&exact, subject.exposure);
    let shown = |frame: &Frame| shown(frame, SAMPLES, exposure, &subject.camera, &subject.map);
    let mut tiles = vec![("exact".to_owned(), format!("order {}", subject.order), shown(&exact))];
    for (i, method) in METHODS.into_iter().enumerate() {
        let cost = method.cost(subject.order).total;
        tiles.push((method.to_string(), format!("{cost} operations"), shown(&frames[i])));
        let errors = difference(&pixel_errors(&frames[i], &exact), exact.size, SAMPLES, 0.01);
        tiles.push(("its errors".to_owned(), format!("rms {}", percent(row.errors[i].rms)), errors));
    }
    let [width, height] = SIZE;
    let mut canvas = Canvas::new([tiles.len() * (width + GAP) + GAP, GAP + TITLE + height + LINE + GAP], GROUND);
    for (i, (title, line, tile)) in tiles.iter().enumerate() {
        let left = GAP + i * (width + GAP);
        canvas.write([left, GAP - 2], title, Text::Title, BRIGHT);
        canvas.put([left, GAP + TITLE], tile);
        canvas.write([left, GAP + TITLE + height + GAP / 2], line, Text::Line, MUTED);
    }
    Ok(canvas)
}
