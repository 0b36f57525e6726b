//! The proven rounding bounds: nothing measured exceeds them.

use std::time::Instant;
use zonal_codegen::accuracy::rounding;
use zonal_codegen::bound::prove;
use zonal_codegen::built::kernel;
use zonal_codegen::catalog::standard;
use zonal_codegen::code::Code;
use zonal_codegen::eval::Contraction;
use zonal_codegen::listing::Listing;
use zonal_codegen::spec::{Form, Spec};

#[test]
fn table() {
    let specs: Vec<Spec> = standard().into_iter().filter(|s| !s.rgb && s.form == Form::Unrolled).collect();
    let count: usize = std::env::var("COUNT").ok().and_then(|c| c.parse().ok()).unwrap_or(2000);
    let mut total = 0.0;
    for spec in &specs {
        let listing = Listing::new(&kernel(spec));
        let code = Code::Straight(listing.clone());
        let start = Instant::now();
        let bound = prove(spec, &listing);
        let time = start.elapsed().as_secs_f64();
        total += time;
        let measured = [Contraction::Separate, Contraction::Fused].map(|c| rounding::<f32>(spec, &code, 7, count, c));
        match bound {
            Some(b) => println!(
                "{:24} {:9.2e} {:9.2e}  measured {:9.2e} {:9.2e}  ratio {:6.2} {:6.2}  {:.3}s {}",
                spec.to_string(),
                b.separate,
                b.fused,
                measured[0],
                measured[1],
                b.separate / measured[0],
                b.fused / measured[1],
                time,
                if measured[0] > b.separate || measured[1] > b.fused { "VIOLATED" } else { "" }
            ),
            None => println!("{:24} none", spec.to_string()),
        }
    }
    println!("total {total}");
}
