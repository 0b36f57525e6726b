//! What a plan says of its environment, to a person who lights scenes: which order, what it errs by and why, where it is
//! negative, what else could go.

use super::environment::EnvironmentPlan;
use super::text::capital;
use super::text::{percent, row, table};
use crate::environment::{Lamps, Negative};
use crate::families::family::MAX_ORDER;
use crate::reflectance::requirement::Requirement;
use crate::scene::Light;
use crate::scene::budget::RelativeTo;
use std::fmt;

/// A number with two digits.
fn two_digits(value: f64) -> String {
    match value.abs() {
        v if (0.1..10.0).contains(&v) => format!("{value:.1}"),
        v if (0.001..0.1).contains(&v) => format!("{value:.3}"),
        v if (10.0..1000.0).contains(&v) => format!("{value:.0}"),
        0.0 => "0".to_owned(),
        _ => format!("{value:.0e}"),
    }
}

/// Where the energy of a map is, in a sentence; nothing if it is spread out.
pub fn lamps(lamps: &Lamps) -> Option<String> {
    let what = if lamps.are_one() { "one small light" } else { "small lights" };
    let hold = if lamps.are_one() { "holds" } else { "hold" };
    let texels = match lamps.texels {
        1 => format!("one texel of {}", lamps.of),
        count => format!("{count} texels of {}", lamps.of),
    };
    lamps.are_small().then(|| {
        format!(
            "{}, {texels}, {hold} {} of the map's energy, its squared radiance over the sphere: no low order shows {} as {}, \
             but a surface that is no mirror blurs it",
            capital(what),
            percent(lamps.share),
            if lamps.are_one() { "it" } else { "them" },
            if lamps.are_one() { "it is" } else { "they are" },
        )
    })
}

/// Where an order is negative, in a sentence.
pub fn negative(what: &str, order: usize, found: &Negative) -> String {
    match found.share > 0.0 {
        true => format!(
            "{what} of order {order} has R, G or B below zero in {} of all directions, down to \
             {} times its mean",
            percent(found.share),
            two_digits(found.least)
        ),
        false => format!("{what} of order {order} is below zero nowhere"),
    }
}

impl EnvironmentPlan {
    /// What the error is the error of, in a sentence.
    pub fn meaning(&self) -> String {
        let (over, of) = match (self.signal, &self.brdf) {
            (Light::Irradiance, _) => ("all normals", "the light that a diffuse surface gets"),
            (Light::Radiance, Some(_)) => ("all normals and views", "the light that is reflected"),
            (Light::Radiance, None) => ("all directions", "the light"),
        };
        format!(
            "Errors here are of what one sees: root mean squares over {over}, R, G and B together, as a share of that of \
             {of} with all of its bands"
        )
    }

    /// What was decided about the order, in a sentence or two.
    pub fn verdict(&self) -> String {
        let seen = self.seen();
        let (order, most, budget) = (self.order, self.max_order, percent(self.budget));
        let error = |order: usize| percent(self.errors[order - 1]);
        let cost = |order: usize| percent(self.costs[order - 1]);
        match (self.relative_to, self.kept) {
            (RelativeTo::AllBands, true) => {
                format!(
                    "order {order}, which is bands 0 to {}: {seen} errs by {}, within the scene's budget of {budget}; order {} \
                     would err by {}",
                    order - 1,
                    error(order),
                    order - 1,
                    error(order - 1)
                )
            }
            (RelativeTo::AllBands, false) => {
                let other = match self.would_keep {
                    Some(other) if other <= MAX_ORDER => format!("order {other} would keep it"),
                    Some(other) => format!("order {other} would keep it, and kernels go up to order {MAX_ORDER}"),
                    None => "no order up to 32 would keep it".to_owned(),
                };
                format!(
                    "order {order}, the most that the scene affords, does not keep the budget of {budget}: {seen} errs by \
                     {}; {other}",
                    error(order)
                )
            }
            (RelativeTo::MaxOrder, _) if order == most => format!(
                "order {order}, all that the scene affords: order {} would err by {} against it, and the budget is \
                 {budget}. Against all bands, which is what one sees, {seen} errs by {}",
                order - 1,
                cost(order - 1),
                error(order)
            ),
            (RelativeTo::MaxOrder, _) => format!(
                "order {order}: against order {most}, the most that the scene affords, {seen} errs by {}, within the \
                 budget of {budget}; order {} would err by {}. Against all bands, which is what one sees, order {order} errs \
                 by {}",
                cost(order),
                order - 1,
                cost(order - 1),
                error(order)
            ),
        }
    }

    /// What a warning has to say, if the budget is not kept.
    pub fn warning(&self) -> Option<String> {
        (!self.kept).then(|| format!("`{}`: {}", self.name, self.verdict()))
    }

    /// Why, and what else there is to know, a sentence each.
    pub fn reasons(&self) -> Vec<String> {
        let mut reasons = vec![self.meaning()];
        reasons.extend(self.told.as_deref().map(capital));
        reasons.extend(lamps(&self.lamps));
        if self.signal == Light::Radiance && self.brdf.is_none() {
            let order = self.order.min(3);
            reasons.push(format!(
                "Say what the surface reflects in a `[brdf]` if it is no mirror: diffuse light of order {order} errs by {}",
                percent(self.diffuse_errors[order - 1])
            ));
        }
        let what = match self.signal {
            Light::Radiance => "The light itself",
            Light::Irradiance => "The irradiance",
        };
        reasons.push(negative(what, self.order, &self.negative));
        let missing: Vec<String> =
            self.vanishing.iter().filter(|l| !self.bands.contains(l)).map(usize::to_string).collect();
        if !missing.is_empty() {
            let (bands, hold) = if missing.len() == 1 { ("Band", "holds") } else { ("Bands", "hold") };
            reasons.push(format!("{bands} {} {hold} nothing", missing.join(", ")));
        }
        let ([coefficients, all], [operations, whole]) = (self.coefficients, self.operations);
        if coefficients < all {
            reasons.push(format!(
                "An evaluation in a direction takes {operations} multiplications, additions or multiply-adds for R, G and B \
                 together, of {coefficients} RGB coefficients; at the most that the scene affords, order {}, {whole} of {all}",
                self.max_order
            ));
        }
        reasons.extend(self.in_monomials());
        reasons
    }

    /// What was decided and why, in a few sentences.
    pub fn summary(&self) -> String {
        let all: Vec<String> = std::iter::once(self.verdict()).chain(self.reasons()).collect();
        all.join(". ") + "."
    }
}

impl fmt::Display for EnvironmentPlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(f, "## Environment `{}`\n", self.name)?;
        let signal = match self.signal {
            Light::Radiance => "radiance",
            Light::Irradiance => "irradiance",
        };
        writeln!(f, "`{}`, {width} x {height}, {signal}. Chosen: {} {}\n", self.map, self.summary(), self.axes())?;
        let relative = self.relative_to == RelativeTo::MaxOrder;
        let blurred = self.signal == Light::Irradiance || self.brdf.is_some();
        let seen = match (self.signal, self.brdf.is_some()) {
            (Light::Irradiance, _) => "the diffuse light",
            (Light::Radiance, true) => "the reflected light",
            (Light::Radiance, false) => "the light",
        };
        let mut head = row(["band"]);
        head.push(format!("share of the energy of {seen} below order {}", self.max_order));
        head.push(format!("error of {seen} if it is the last"));
        if relative {
            head.push(format!("that error against order {}", self.max_order));
        }
        if blurred {
            head.push("error of the light itself if it is the last".to_owned());
        }
        head.push(String::new());
        let mut rows = vec![head];
        for l in 0..self.max_order {
            let mut line = vec![l.to_string(), percent(self.energy[l]), percent(self.errors[l])];
            if relative {
                line.push(percent(self.costs[l]));
            }
            if blurred {
                line.push(percent(self.light_errors[l]));
            }
            line.push(
                match (l < self.order, self.bands.contains(&l)) {
                    _ if self.vanishing.contains(&l) => "holds nothing",
                    (true, true) if l + 1 == self.order => "the last that is kept",
                    (true, _) => "kept",
                    (false, _) => "left out",
                }
                .to_owned(),
            );
            rows.push(line);
        }
        f.write_str(&table(&rows))?;
        if let Some(requirement) = &self.requirement {
            write_requirement(f, requirement, self)?;
        }
        Ok(())
    }
}

/// What else the reflectance would let go.
fn write_requirement(f: &mut fmt::Formatter<'_>, required: &Requirement, plan: &EnvironmentPlan) -> fmt::Result {
    writeln!(f, "\n## What `{}` needs of this light\n", required.brdf)?;
    let mut needs = vec![format!("Bands below order {}", required.order)];
    if required.isotropic {
        needs.push("and of the reflectance one azimuth of the view, without the terms of negative degree".to_owned());
    }
    writeln!(f, "{}.", needs.join(", "))?;
    match &required.left[..] {
        [] => writeln!(f, "Nothing else of the light can go within the budget.")?,
        left => {
            writeln!(
                f,
                "A renderer may leave out more of the light within the budget; zonal's files hold all of it:\n"
            )?;
            for left in left {
                writeln!(f, "* {}, which errs by {};", left.what, percent(left.error))?;
            }
            writeln!(f, "\nAll together, with the bands that are left out, err by {}.", percent(required.error))?;
        }
    }
    let ([operations, all], [bytes, all_bytes]) = (required.operations, required.bytes);
    writeln!(
        f,
        "\nA pixel then takes {operations} operations (to turn the light and multiply it with the reflectance), and light \
         and reflectance {bytes} bytes. In RGB at order {}, without anything left out, they take {all} operations and \
         {all_bytes} bytes.",
        plan.max_order
    )
}
