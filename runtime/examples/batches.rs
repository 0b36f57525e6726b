//! Many signals turned at once, in two layouts, and each beside what is computed of it alone in f64: it fails where one is off.
//! On another architecture it is run in an emulator.
//!
//! `cargo run -p zonal --example batches --features batch`

use zonal::batch::{self, Block, Unit};

const COUNT: usize = 1000;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Quaternions on a spiral, and signals of order 5 that differ.
    let quaternion = |k: usize| {
        let (a, b) = (0.37 * k as f64, 0.11 * k as f64);
        [a.sin() * b.sin(), a.sin() * b.cos(), a.cos() * b.sin(), a.cos() * b.cos()]
    };
    let quaternions: Vec<[f32; 4]> = (0..COUNT).map(|k| quaternion(k).map(|x| x as f32)).collect();
    let arrays: Vec<[f32; 25]> =
        (0..COUNT).map(|k| std::array::from_fn(|i| ((7 * k + 3 * i) % 17) as f32 / 8.0 - 1.0)).collect();

    // Arrays as they lie; blocks of sixteen, which are faster.
    let mut turned = vec![[0.0_f32; 25]; COUNT];
    batch::rotate_each(&quaternions, &arrays, &mut turned)?;
    let mut blocks = vec![Block::<f32, 25>::zero(); Block::<f32, 25>::count(COUNT)];
    batch::copy_each(&arrays, &mut blocks)?;
    batch::rotate_each_in_place(&quaternions, &mut blocks)?;

    let mut worst = 0.0_f64;
    for k in 0..COUNT {
        let alone = zonal::rotate(quaternion(k), &arrays[k].map(f64::from));
        for i in 0..25 {
            let of_block = blocks[k / 16].0[i][k % 16];
            worst = worst.max((alone[i] - f64::from(turned[k][i])).abs()).max((alone[i] - f64::from(of_block)).abs());
        }
    }
    println!("{COUNT} signals on {}: at most {worst:.1e} from one at a time in f64", Unit::used());
    // The kernel's bound of 1.3e-5 for a band of norm 3, and the quaternions' rounding.
    if worst < 5e-5 { Ok(()) } else { Err(format!("{worst:e} is too far").into()) }
}
