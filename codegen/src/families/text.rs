//! Specs as text, `rotate:5:zxzxz:rgb`: read, written, and refused with what to do.

use crate::families::all::ALL;
use crate::families::family::{
    ByBand, Family, Form, MAX_HALF_ORDER, MAX_LOOP_ORDER, MAX_ORDER, MIN_ORDER, Spec, Spelled,
};
use crate::families::parts::small_angle::SmallAngle;
use crate::families::{choices, factors};
use crate::fault::hint;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Why a text is no spec.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}; {help}")]
pub struct SpecError {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
    /// Which bytes of the spec are meant.
    pub at: Range<usize>,
}

/// The methods of bands that stand in the place of a family's name.
fn as_family(family: &Family) -> bool {
    family.by_band.is_some_and(|by_band| by_band.spelled == Spelled::AsFamily)
}

/// The methods of bands that stand in the place of a method.
fn as_method(family: &Family) -> bool {
    family.by_band.is_some_and(|by_band| by_band.spelled == Spelled::AsMethod)
}

/// Every name that a spec may start with, each once.
pub fn family_names() -> Vec<&'static str> {
    let mut names: Vec<&str> = Vec::new();
    for family in ALL {
        if as_family(family) {
            names.extend(SmallAngle::APPROXIMATE.map(SmallAngle::name));
        }
        if !names.contains(&family.name) {
            names.push(family.name);
        }
    }
    names
}

/// The kernel that a name alone means.
///
/// # Panics
///
/// If there is no such family.
pub fn usual(name: &str, order: usize, rgb: bool) -> Spec {
    let family = ALL.iter().find(|family| family.name == name && (family.usual)(order, rgb));
    Spec { rgb, ..Spec::new(family.unwrap_or_else(|| panic!("`{name}` is no family")), order) }
}

/// Every method that the family of a name takes.
fn method_names(name: &str) -> Vec<&'static str> {
    let own = ALL.iter().filter(|family| family.name == name && !family.method.is_empty());
    let (lists, methods): (Vec<&&Family>, Vec<&&Family>) = own.partition(|family| as_method(family));
    let mut names: Vec<&str> = methods.iter().map(|family| family.method).collect();
    if !lists.is_empty() {
        names.extend(SmallAngle::APPROXIMATE.map(SmallAngle::name));
    }
    names
}

/// The families' names that a list names, in a sentence.
fn in_a_row(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match &quoted[..] {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        _ => quoted.concat(),
    }
}

fn approximate(name: &str) -> Option<SmallAngle> {
    SmallAngle::named(name).filter(|method| *method != SmallAngle::Exact)
}

/// A list of methods, one a band.
fn joined(methods: &[SmallAngle]) -> String {
    methods.iter().map(|method| method.name()).collect::<Vec<_>>().join("+")
}

impl ByBand {
    /// What a spec or a name has to say of these methods: one name if it stands for all of them, nothing if it is left out.
    fn list(&self, methods: &[SmallAngle], order: usize) -> Option<String> {
        let last = methods.last().filter(|last| *methods == self.alone(**last, order));
        match (self.spelled, last) {
            (_, None) => Some(joined(methods)),
            (Spelled::AsOption, Some(SmallAngle::Lf3)) => None,
            (Spelled::AsOption, Some(SmallAngle::Exact)) if order <= 3 => None,
            (_, Some(last)) => Some(last.name().to_owned()),
        }
    }
}

impl Spec {
    /// What a spec says of its bands' methods.
    fn list(&self) -> Option<String> {
        self.family.by_band.and_then(|by_band| by_band.list(&self.methods, self.order))
    }

    /// Whether the family's name alone means it.
    fn is_usual(&self) -> bool {
        (self.family.usual)(self.order, self.rgb)
    }

    /// What the function is called after its prefix `sh<order>_`, where it has one; unique among specs of one order. It
    /// never ends in a digit and never holds `__`, since naga renames such names.
    pub fn stem(&self) -> String {
        let mut name = String::new();
        if !self.is_whole() {
            let bands: Vec<String> = self.bands.iter().map(usize::to_string).collect();
            name += &format!("bands_{}_", bands.join("_"));
        }
        if let Some(list) = self.list() {
            name += &format!("{}_", list.replace('+', "_"));
        }
        match (self.factors, &self.family.converts) {
            (Some([from, _]), Some(_)) => name += &format!("of_order_{from}_"),
            (Some([a, b]), None) => name += &format!("of_sh{a}_and_sh{b}_"),
            (None, _) => {}
        }
        name += if !self.family.method.is_empty() && self.is_usual() { self.family.name } else { self.family.stem };
        for choice in &self.chosen {
            match choice.split_once('=') {
                Some((choice, order)) => name += &format!("_order_{order}_{choice}"),
                None => name += &format!("_{choice}"),
            }
        }
        if name.ends_with(|last: char| last.is_ascii_digit()) {
            name += "_form";
        }
        if self.rgb {
            name += "_rgb";
        }
        if self.form == Form::Loop {
            name += "_loop";
        }
        if self.half {
            name += "_half";
        }
        name
    }

    /// The function's name in shaders.
    pub fn name(&self) -> String {
        if self.family.one_order { self.stem() } else { format!("sh{}_{}", self.order, self.stem()) }
    }
}

impl fmt::Display for Spec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (order, family) = (self.order, self.family);
        let list = self.list();
        if let Some([a, b]) = self.factors {
            write!(f, "{}:{a}+{b}", family.name)?;
            if family.converts.is_none() {
                write!(f, ":{order}")?;
            }
        } else {
            match (list, family.by_band.map(|by_band| by_band.spelled)) {
                (Some(list), Some(Spelled::AsFamily)) if !list.contains('+') => write!(f, "{list}:{order}")?,
                (Some(list), _) => write!(f, "{}:{order}:{list}", family.name)?,
                (None, _) => {
                    f.write_str(family.name)?;
                    if !family.one_order {
                        write!(f, ":{order}")?;
                    }
                    if !family.method.is_empty() && !self.is_usual() {
                        write!(f, ":{}", family.method)?;
                    }
                }
            }
        }
        for choice in &self.chosen {
            write!(f, ":{choice}")?;
        }
        if !self.is_whole() {
            let bands: Vec<String> = self.bands.iter().map(usize::to_string).collect();
            write!(f, ":bands={}", bands.join("+"))?;
        }
        if self.rgb {
            write!(f, ":rgb")?;
        }
        if self.form == Form::Loop {
            write!(f, ":loop")?;
        }
        if self.half {
            write!(f, ":f16")?;
        }
        Ok(())
    }
}

/// The options that some family of a name takes.
fn option_names(name: &str) -> Vec<&'static str> {
    let any = |takes: fn(&Family) -> bool| ALL.iter().any(|family| family.name == name && takes(family));
    let mut options: Vec<&str> = choices::of_name(name).concat();
    if any(|family| family.has_signal()) {
        options.push("rgb");
    }
    if any(|family| family.looped.is_some()) {
        options.push("loop");
    }
    if any(|family| family.half) {
        options.push("f16");
    }
    if any(|family| family.some_bands) {
        options.push("bands=0+1+2");
    }
    options
}

/// A piece of a spec's text and where it stands.
struct Piece<'a> {
    text: &'a str,
    at: Range<usize>,
}

impl Piece<'_> {
    fn error(&self, message: String, help: impl Into<String>) -> SpecError {
        SpecError { message, help: help.into(), at: self.at.clone() }
    }
}

fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut start = 0;
    text.split(':')
        .map(|piece| {
            let at = start..start + piece.len();
            start = at.end + 1;
            Piece { text: piece, at }
        })
        .collect()
}

/// A method for each band; one alone is made a list of, as the family says.
fn parse_methods(piece: &Piece<'_>, order: usize, by_band: &ByBand) -> Result<Vec<SmallAngle>, SpecError> {
    let exact = by_band.takes_exact();
    let names: Vec<&str> = piece.text.split('+').collect();
    let mut known = SmallAngle::APPROXIMATE.map(SmallAngle::name).to_vec();
    if exact {
        known.push(SmallAngle::Exact.name());
    }
    let mut methods = Vec::new();
    for name in &names {
        let method = if exact { SmallAngle::named(name) } else { approximate(name) };
        let method = method
            .ok_or_else(|| piece.error(format!("`{name}` is no method for a small angle here"), hint(name, &known)))?;
        methods.push(method);
    }
    if methods.len() == 1 {
        methods = by_band.alone(methods[0], order);
    }
    if methods.len() != order - 1 {
        let message = format!("{} methods for the bands 1 to {}", methods.len(), order - 1);
        return Err(piece.error(message, format!("name one for all bands or {} joined by `+`", order - 1)));
    }
    Ok(methods)
}

fn parse_bands(piece: &Piece<'_>, list: &str, order: usize) -> Result<Vec<usize>, SpecError> {
    let mut bands = Vec::new();
    for text in list.split('+') {
        let band: usize = text
            .parse()
            .map_err(|_| piece.error(format!("`{text}` is no band"), "write bands as in `bands=0+1+2+4`"))?;
        if band >= order {
            let message = format!("band {band} is not below the order {order}");
            return Err(piece.error(message, format!("an order n has the bands 0 to n − 1: raise it to {}", band + 1)));
        }
        bands.push(band);
    }
    bands.sort_unstable();
    bands.dedup();
    Ok(bands)
}

fn orders() -> String {
    format!("orders are {MIN_ORDER} to {MAX_ORDER}, in loop form to {MAX_LOOP_ORDER}")
}

fn parse_order(piece: &Piece<'_>) -> Result<usize, SpecError> {
    in_range(piece, piece.text.parse().map_err(|_| piece.error(format!("`{}` is no order", piece.text), orders()))?)
}

fn in_range(piece: &Piece<'_>, order: usize) -> Result<usize, SpecError> {
    match (MIN_ORDER..=MAX_LOOP_ORDER).contains(&order) {
        true => Ok(order),
        false => Err(piece.error(format!("order {order} is out of range"), orders())),
    }
}

/// The first name of a list of methods.
fn first_of<'a>(piece: &Piece<'a>) -> &'a str {
    piece.text.split('+').next().unwrap_or(piece.text)
}

/// What stands between a spec's order and its options: the family, the methods of its bands, and what follows.
type Head<'a> = (&'static Family, Vec<SmallAngle>, &'a [Piece<'a>]);

/// The family that a spec begins with, where no method follows the order, and the methods of its bands.
fn parse_head<'a>(name: &str, order: &Piece<'_>, n: usize, rest: &'a [Piece<'a>]) -> Result<Head<'a>, SpecError> {
    let alone = approximate(name);
    let named = |family: &&&Family| {
        if as_family(family) { alone.is_some() || family.name == name } else { family.name == name }
    };
    let family = ALL.iter().find(named).expect("the name is known");
    let Some(by_band) = family.by_band.as_ref().filter(|by_band| by_band.spelled != Spelled::AsMethod) else {
        return Ok((family, vec![], rest));
    };
    match (by_band.spelled, alone, rest) {
        (Spelled::AsFamily, Some(method), _) => Ok((family, by_band.alone(method, n), rest)),
        (Spelled::AsFamily, None, []) => Err(order.error(
            format!("`{name}` names no methods"),
            "write one a band, as in `mix:5:taylor15+taylor15+taylor15+taylor1`",
        )),
        (Spelled::AsFamily, None, [list, others @ ..]) => Ok((family, parse_methods(list, n, by_band)?, others)),
        (_, _, [list, others @ ..]) if SmallAngle::named(first_of(list)).is_some() => {
            Ok((family, parse_methods(list, n, by_band)?, others))
        }
        _ => Ok((family, by_band.alone(SmallAngle::Lf3, n), rest)),
    }
}

impl FromStr for Spec {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Self, SpecError> {
        let all = pieces(text);
        let [head, rest @ ..] = &all[..] else {
            unreachable!("splitting always gives one piece");
        };
        let names = family_names();
        if !names.contains(&head.text) {
            return Err(head.error(format!("`{}` is no family of kernels", head.text), hint(head.text, &names)));
        }
        let takes = |of: fn(&Family) -> bool| ALL.iter().any(|family| family.name == head.text && of(family));
        let converts = takes(|family| family.converts.is_some());
        let (factors, rest) = match rest {
            [first, others @ ..] if first.text.contains('+') && (converts || takes(|family| family.factors)) => {
                let example = if converts { format!("{}:5+3", head.text) } else { "product:2+3:4".to_owned() };
                let both = factors::read(first.text, &example).map_err(|[message, help]| first.error(message, help))?;
                // A conversion's second order is the result's, and stands in its place.
                (Some(both), if converts { rest } else { others })
            }
            _ => (None, rest),
        };
        let alone = ALL.iter().find(|family| family.name == head.text && family.one_order);
        let (order_piece, order, options) = match (alone, rest.split_first()) {
            (Some(family), _) => (head, *family.orders.start(), rest),
            (None, Some((piece, options))) => match factors.filter(|_| converts) {
                Some([_, order]) => (piece, in_range(piece, order)?, options),
                None => (piece, parse_order(piece)?, options),
            },
            (None, None) => {
                let help = format!("write it as in `{}:5`", head.text);
                return Err(head.error(format!("`{text}` names no order"), help));
            }
        };
        let (family, methods, options) = parse_head(head.text, order_piece, order, options)?;
        let factors = factors.filter(|both| !converts || *both != [order; 2]);
        let mut spec = Self { methods, factors, ..Self::new(family, order) };
        let known = method_names(head.text);
        let mut is_open = !known.is_empty();
        for option in options {
            match option.text {
                "rgb" if spec.rgb => return Err(option.error("`rgb` stands twice".to_owned(), "leave one out")),
                "rgb" => spec.rgb = true,
                "loop" => spec.form = Form::Loop,
                "f16" => spec.half = true,
                _ if option.text.starts_with("bands=") => {
                    spec.bands = parse_bands(option, &option.text["bands=".len()..], order)?;
                }
                name if choices::of_name(head.text).concat().contains(&name) => {
                    spec = spec.also(name).map_err(|[message, help]| option.error(message, help))?;
                }
                name if is_open => {
                    if !known.contains(&first_of(option)) {
                        let all = [known, option_names(head.text)].concat();
                        let message = format!("`{name}` is no method of `{}`", head.text);
                        return Err(option.error(message, hint(name, &all)));
                    }
                    is_open = false;
                    let is_own = |family: &&&Family| family.name == head.text && family.method == name;
                    let takes_list = |family: &&&Family| family.name == head.text && as_method(family);
                    let own = ALL.iter().find(|family| is_own(family) && !as_method(family));
                    spec.family = own.or_else(|| ALL.iter().find(takes_list)).expect("the method is known");
                    if let Some(by_band) = &spec.family.by_band {
                        spec.methods = parse_methods(option, order, by_band)?;
                    }
                }
                name => {
                    let known = option_names(spec.family.name);
                    let help =
                        if known.is_empty() { "leave it out: there is none".to_owned() } else { hint(name, &known) };
                    return Err(option.error(format!("`{name}` is no option of `{}`", head.text), help));
                }
            }
        }
        if is_open {
            let own = || ALL.iter().filter(|family| family.name == head.text);
            let usual = || own().find(|family| (family.usual)(order, spec.rgb));
            let looped = own().find(|family| spec.form == Form::Loop && family.looped.is_some());
            // Of a family without a loop form it is refused below.
            spec.family = looped.or_else(usual).expect("one of a family's methods is the usual one");
        }
        spec.check(&Piece { text, at: 0..text.len() })?;
        Ok(spec)
    }
}

impl Spec {
    /// Whether it has a loop form.
    fn has_loop(&self) -> bool {
        self.family.looped.is_some_and(|looped| (looped.has)(self))
    }

    /// Refuses combinations that no kernel exists for.
    fn check(&self, whole: &Piece<'_>) -> Result<(), SpecError> {
        let (order, family) = (self.order, self.family);
        if self.rgb && !family.has_signal() {
            let message = format!("`{}` has no signal that could be RGB", whole.text);
            return Err(whole.error(message, "leave `rgb` out: its result serves every channel"));
        }
        if !self.is_whole() && !family.some_bands {
            let takers: Vec<&str> = ALL.iter().filter(|family| family.some_bands).map(|family| family.name).collect();
            return Err(whole.error(
                format!("only {} take `bands=`", in_a_row(&takers)),
                "leave it out: a rotation leaves bands apart, so call it at the order that you store",
            ));
        }
        if self.bands.is_empty() {
            return Err(whole.error("no band is left".to_owned(), "name one at least, as in `bands=0+1+2`"));
        }
        if !family.orders.contains(&order) && order <= MAX_ORDER {
            let [message, help] = (family.outside)(order);
            return Err(whole.error(message, help));
        }
        if let Some([message, help]) = factors::fault(self).or_else(|| (family.fault)(self)) {
            return Err(whole.error(message, help));
        }
        if let Some(by_band) = &family.by_band
            && !self.methods.iter().zip(1..).all(|(method, l)| (by_band.in_band)(l).contains(method))
        {
            let [message, help] = by_band.rule;
            return Err(whole.error(message.to_owned(), help));
        }
        if self.form == Form::Loop && !self.has_loop() {
            let loops: Vec<&str> = ALL.iter().filter_map(|family| family.looped).map(|looped| looped.name).collect();
            return Err(whole.error(
                format!("`{}` has no loop form", whole.text),
                format!("{} have one: leave `loop` out", in_a_row(&loops)),
            ));
        }
        if self.half && !self.takes_half() {
            return Err(whole.error(
                format!("`{}` does not work in f16", whole.text),
                // Names a family: it is the way out for whoever needs a rotation in f16.
                format!(
                    "a quaternion's angles, a zonal factorisation, the sizes of lights and loops need f32, and orders end at {MAX_HALF_ORDER}; \
                     `rotate:{}:angles:f16` takes angles that were made in f32",
                    order.min(MAX_HALF_ORDER)
                ),
            ));
        }
        if self.form == Form::Unrolled && !family.orders.contains(&order) {
            let [message, help] = (family.outside)(order);
            return Err(match self.has_loop() {
                true => whole.error(message, format!("write `{}:loop`", whole.text)),
                false => whole.error(message, help),
            });
        }
        Ok(())
    }
}
