//! A plan as people read it: what each kernel costs and why it was chosen.

use crate::plan::Plan;
use crate::plan::contest::{
    HALF_SHARE, ISSUE_CYCLES, MEMORY_CYCLES, READ_WEIGHT, RESULT_CYCLES, SPECIAL_WEIGHT, SPILL_WEIGHT,
};
use crate::plan::text::{row, short, table};
use crate::promise::registers::MOST;
use crate::scene::Hemisphere;
use std::fmt;

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let targets: Vec<&str> = self.targets.iter().map(|target| target.name).collect();
        writeln!(f, "# {}\n\nTargets: {}.\n", self.scene, targets.join(", "))?;
        if let Some(environment) = &self.environment {
            writeln!(f, "{environment}")?;
        }
        if self.kernels.is_empty() {
            return Ok(());
        }
        let mut rows = vec![row([
            "kernel",
            "function",
            "total",
            "special",
            "constants",
            "live",
            "registers",
            "f32 rounding",
            "method error",
            "why",
        ])];
        for chosen in &self.kernels {
            rows.push(vec![
                format!("`{}`", chosen.row.spec),
                format!("`{}`", chosen.row.name),
                chosen.row.cost.total.to_string(),
                chosen.row.cost.special.to_string(),
                chosen.row.footprint.constants.to_string(),
                chosen.row.footprint.live.to_string(),
                chosen.row.registers.to_string(),
                short(chosen.row.accuracy.rounding_f32),
                match (chosen.method_error, chosen.max_angle) {
                    (Some(error), Some(angle)) if error > 1e-12 => format!("{} at {angle} degrees", short(error)),
                    (None, _) if !chosen.row.accuracy.method.is_empty() => "grows with the angle".to_owned(),
                    _ => "none".to_owned(),
                },
                chosen.reason.clone(),
            ]);
        }
        writeln!(f, "## Kernels\n")?;
        f.write_str(&table(&rows))?;
        writeln!(
            f,
            "\nTotal: multiplications, additions and multiply-adds, one each. Special: inverse square roots and reciprocals. \
             Registers: vector registers on RDNA 2, as measured, `+` those that memory stands in for; `about` as counted."
        )?;
        for chosen in self.kernels.iter().filter(|chosen| !chosen.rivals.is_empty()) {
            writeln!(f, "\n## Why `{}`\n\nIt is {}.\n", chosen.row.spec, chosen.reason)?;
            let mut rows = vec![row([
                "method",
                "takes",
                "total",
                "special",
                "reads",
                "held",
                "waves",
                "price",
                "method error",
                "f32 rounding",
                "verdict",
            ])];
            for rival in &chosen.rivals {
                rows.push(vec![
                    match &rival.set_up {
                        Some(set_up) => format!("`{}` after `{set_up}`", rival.spec),
                        None => format!("`{}`", rival.spec),
                    },
                    rival.takes.join(", "),
                    rival.total.to_string(),
                    rival.special.to_string(),
                    rival.reads.to_string(),
                    rival.held.to_string(),
                    rival.waves.to_string(),
                    rival.price.to_string(),
                    short(rival.method_error),
                    short(rival.rounding_f32),
                    rival.verdict.clone(),
                ]);
            }
            f.write_str(&table(&rows))?;
            writeln!(
                f,
                "\nThe price is the total, {SPECIAL_WEIGHT} for each special and {READ_WEIGHT} for each number that is read besides the signal; or what a wave waits for, if that is more: {RESULT_CYCLES} cycles for each of these of one channel and {MEMORY_CYCLES} for memory, by {ISSUE_CYCLES} cycles an operation and by the waves that registers leave room for on RDNA 2. And {SPILL_WEIGHT} for each number that is held at once beyond {MOST}, unless the scene says how many registers may be taken; in f16 by {HALF_SHARE}. Errors are {}, at the largest angle.",
                chosen.hemisphere.map_or_else(|| chosen.norm.unwrap_or_default().meaning(), Hemisphere::meaning)
            )?;
        }
        Ok(())
    }
}
