//! What becomes of the claims of Habel and Wimmer 2010, by the figures that were measured.

use super::Hemisphere;
use super::irradiance::{FIGURE_3, Rank};
use crate::markdown::{percent, short};

/// A claim of a paper, whether it holds here, and by which figures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// What is claimed.
    pub claim: &'static str,
    /// Whether it holds.
    pub holds: bool,
    /// The figures.
    pub figures: String,
}

/// A basis by its name.
pub(super) fn rank<'a>(ranks: &'a [Rank], name: &str) -> &'a Rank {
    ranks.iter().find(|rank| rank.basis == name).expect("a report holds every basis")
}

/// What Habel and Wimmer 2010 claim of their Figure 3 and of irradiance in spherical harmonics.
pub fn claims(hemisphere: &Hemisphere) -> Vec<Claim> {
    let ranks = &hemisphere.irradiance;
    let error = |name: &str| rank(ranks, name).figure_3;
    let figure = |names: &[&str]| {
        let one = |name: &&str| format!("{name}: {}", short(1e3 * error(name)));
        names.iter().map(one).collect::<Vec<_>>().join(" · ") + " (· 10⁻³)"
    };
    let claim = |claim, holds, figures| Claim { claim, holds, figures };
    let (h4, h6, linear) = (error("H4"), error("H6"), error("SH, order 2, least squares"));
    let others = |coefficients: usize, but: &'static str| {
        ranks.iter().filter(move |rank| rank.coefficients == coefficients && !rank.basis.starts_with(but))
    };
    let (three, five) = (error("H6 from SH of order 3"), error("H6 from SH of order 5"));
    let rms = rank(ranks, "SH, order 3, of the whole sphere").rms;
    let maps = &rank(ranks, "SH, order 3, of the whole sphere").maps;
    let mean = maps.iter().sum::<f64>() / maps.len() as f64;
    let (least, most) = (maps.iter().copied().fold(1.0, f64::min), maps.iter().copied().fold(0.0, f64::max));
    let better =
        rank(ranks, "H6").maps.iter().zip(&rank(ranks, "HSH, order 3").maps).filter(|(h6, hsh)| h6 < hsh).count();
    vec![
        claim(
            "H4 equals least-squares linear SH",
            (h4 / linear - 1.0).abs() < 1e-6,
            figure(&["H4", "SH, order 2, least squares"]),
        ),
        claim(
            "H6 has the least error of all bases with six coefficients",
            others(6, "H6").all(|rank| rank.figure_3 > h6),
            figure(&["H6", "Zernike, degrees to 2"]),
        ),
        claim(
            "H6 errs by less than HSH with nine",
            error("HSH, order 3") > h6,
            format!("{}; and on {better} of the {} maps", figure(&["H6", "HSH, order 3"]), maps.len()),
        ),
        claim(
            "Zernike with three errs by less than Half-Life 2",
            error("Zernike, degrees to 1") < error("Half-Life 2"),
            figure(&["Zernike, degrees to 1", "Half-Life 2"]),
        ),
        claim(
            "Of those with nine only SH errs by less than H6",
            others(9, "SH").all(|rank| rank.figure_3 > h6)
                && ranks
                    .iter()
                    .filter(|rank| rank.coefficients == 9 && rank.basis.starts_with("SH"))
                    .all(|sh| sh.figure_3 < h6),
            figure(&["SH, order 3, least squares", "SH, order 3, of the whole sphere", "H6", "HSH, order 3"]),
        ),
        claim(
            "T_h⁴ changes nothing that one sees",
            // The error changes by less than two per cent of itself.
            five / three > 0.98,
            format!(
                "{}; its part is {} % of the irradiance in rms terms",
                figure(&["H6 from SH of order 3", "H6 from SH of order 5"]),
                percent((three - five).sqrt())
            ),
        ),
        claim(
            "SH of order 3 errs by less than 3 % on average",
            rms < 0.03 && mean < 0.03,
            format!(
                "over the {FIGURE_3} signals {} % of the rms on average; on the maps, above the horizon, {} %, from {} to {} %",
                percent(rms),
                percent(mean),
                percent(least),
                percent(most)
            ),
        ),
    ]
}
