//! What the commands print. All of it comes from the library; here it is only laid out.

use super::told;
use std::path::{Path, PathBuf};
use std::time::Instant;
use zonal_cli::projected::{Asked, Projected};
use zonal_cli::scene;
use zonal_cli::terminal::{Failure, out, out_json, progress};
use zonal_codegen::builder;
use zonal_codegen::catalog;
use zonal_codegen::emit::Module;
use zonal_codegen::emit::language::{self, Arrays};
use zonal_codegen::families::several::several;
use zonal_codegen::files::{self, Difference, Replace};
use zonal_codegen::generate::{self, Row};
use zonal_codegen::plan::text::table;
use zonal_codegen::scene::diagnostic::Diagnostic;

pub fn generate(path: Option<&Path>, folder: Option<PathBuf>, replace: Replace) -> Result<(), Failure> {
    let start = Instant::now();
    let bar = progress("planning, generating and validating");
    let plan = scene::plan(path)?;
    let files = builder::files_of(&plan)?;
    let folder = folder.unwrap_or_else(|| PathBuf::from(&plan.output));
    let changed = files::write(&folder, &files, replace)?;
    drop(bar);

    let targets: Vec<&str> = plan.targets.iter().map(|target| target.name).collect();
    let mut text = format!("{}: for {}\n\n", plan.scene, targets.join(", "));
    text += &told::plan(&plan);
    text += "\n";
    for file in &files {
        text += &format!("  {} ({} bytes)\n", folder.join(&file.path).display(), file.text.len());
    }
    text += &format!(
        "\n{} files, validated, of which {changed} were new or changed, in {:.2} s. `{}.md` tells what each kernel costs and why it was chosen.\n",
        files.len(),
        start.elapsed().as_secs_f64(),
        plan.scene
    );
    out(&text)
}

pub fn plan(path: Option<&Path>, json: bool) -> Result<(), Failure> {
    let bar = progress("planning");
    let plan = scene::plan(path)?;
    drop(bar);
    scene::print(&plan, json)
}

pub fn list(family: Option<&str>, order: Option<u64>, json: bool) -> Result<(), Failure> {
    let mut specs = catalog::standard();
    specs.retain(|spec| {
        let text = spec.to_string();
        family.is_none_or(|family| text.split(':').next() == Some(family))
            && order.is_none_or(|order| spec.order as u64 == order)
    });
    let bar = progress(&format!("measuring {} kernels", specs.len()));
    let rows: Vec<Row> = generate::build(&specs).iter().map(Row::of).collect();
    drop(bar);
    if json {
        return out_json(&rows);
    }
    let head = [
        "spec",
        "total",
        "mul",
        "add",
        "fma",
        "special",
        "constants",
        "live",
        "registers",
        "f32 rounding",
        "method error at 15 degrees",
    ];
    let mut lines = vec![head.map(str::to_owned).to_vec()];
    for row in &rows {
        let (cost, footprint) = (row.cost, row.footprint);
        let numbers = [cost.total, cost.mul, cost.add, cost.fma, cost.special, footprint.constants, footprint.live];
        let method = row.accuracy.method.iter().find(|(degrees, _)| *degrees == 15.0);
        let mut line = vec![row.spec.clone()];
        line.extend(numbers.map(|number| number.to_string()));
        line.push(row.registers.to_string());
        line.push(format!("{:e}", row.accuracy.rounding_f32));
        line.push(method.map_or_else(String::new, |(_, error)| format!("{error:e}")));
        lines.push(line);
    }
    out(&table(&lines))
}

pub fn show(spec: &str, target: &str, arrays: Option<&str>, form: Option<&str>) -> Result<(), Failure> {
    let text = spec;
    let specs = several(text).map_err(|error| Diagnostic::of_spec("SPEC", text, error))?;
    let target = language::named(target).map_err(|message: String| Diagnostic::nowhere(message, ""))?;
    let bar = progress("building and measuring");
    let functions = generate::build(&specs);
    let module = Module {
        name: match &specs[..] {
            [spec] => spec.name(),
            // A name of a file, which needs no more than to be one.
            _ => text.replace([':', '+', '='], "_"),
        },
        origin: format!("`{text}`"),
        functions,
        arrays: arrays.and_then(Arrays::named),
        form: form.and_then(|form| language::forms().into_iter().find(|known| *known == form)),
        ..Module::default()
    };
    let file = generate::file(&module, target, "")?;
    drop(bar);
    out(&file.text)
}

pub fn project(asked: &Asked) -> Result<(), Failure> {
    Projected::new(asked)?.print(asked)
}

/// How many differences of a kind are told one by one.
const SHOWN: usize = 10;

/// The first differences of each kind, a line each, and how many others there are.
fn shown(found: &[Difference]) -> String {
    let lines: Vec<String> = found.iter().map(Difference::to_string).collect();
    let of_kind = |kind: &str| {
        let all: Vec<&str> = lines.iter().map(String::as_str).filter(|line| line.starts_with(kind)).collect();
        let others = match all.len().saturating_sub(SHOWN) {
            0 => String::new(),
            others => format!("{kind} {others} others\n"),
        };
        all.iter().take(SHOWN).map(|line| format!("{line}\n")).collect::<String>() + &others
    };
    ["stale:", "orphaned:", "missing:"].map(of_kind).concat()
}

/// Refuses to treat a folder of something else as a catalogue, from which what nothing generates is removed.
fn refuse(folder: &Path, what: &str) -> Result<(), Failure> {
    let message = format!("`{}` is no catalogue: {what}", folder.display());
    Err(Diagnostic::nowhere(message, "name a new folder, or one that zonal wrote; orphans are removed from it").into())
}

/// Refuses orphans that zonal did not write.
fn refuse_foreign(folder: &Path, found: &[Difference], counts: impl Fn(&str) -> bool) -> Result<(), Failure> {
    for difference in found {
        if let Difference::Orphaned(path) = difference
            && counts(path)
            && !files::is_generated(&folder.join(path))
        {
            return refuse(folder, &format!("zonal did not write its `{path}`"));
        }
    }
    Ok(())
}

pub fn catalog(folder: &Path, check: bool, replace: Replace) -> Result<(), Failure> {
    let start = Instant::now();
    let is_used = std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some());
    if is_used && !check && !folder.join(catalog::COSTS).is_file() {
        return refuse(folder, &format!("it holds files, but no {}", catalog::COSTS));
    }
    // Before the work, of what lies beside the folders: there only the two tables are the catalogue's.
    let is_beside = |path: &str| !path.contains('/') && ![catalog::COSTS, catalog::MANIFEST].contains(&path);
    if !check {
        refuse_foreign(folder, &files::differences(folder, &[], &catalog::BESIDE)?, is_beside)?;
    }
    let bar = progress("generating and validating the catalogue");
    let all = catalog::files()?;
    drop(bar);
    let found = files::differences(folder, &all, &catalog::BESIDE)?;
    if check {
        if found.is_empty() {
            return out(&format!("{} files are as they should be\n", all.len()));
        }
        out(&shown(&found))?;
        let message =
            format!("{} of the files in `{}` differ from what zonal generates", found.len(), folder.display());
        let help = format!("run `zonal catalog --dir {}`", folder.display());
        return Err(Diagnostic::nowhere(message, help).into());
    }
    refuse_foreign(folder, &found, |_| true)?;
    let changed = files::write(folder, &all, replace)?;
    let removed = files::remove_orphans(folder, &all, &catalog::BESIDE)?;
    out(&format!(
        "{} files in `{}`, all validated: {changed} changed, {removed} removed, in {:.1} s\n",
        all.len(),
        folder.display(),
        start.elapsed().as_secs_f64()
    ))
}
