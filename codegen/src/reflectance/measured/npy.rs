//! Arrays as NumPy saves them: a head that says their shape and type, then the numbers. It takes floats, little endian, the
//! last index fastest, and knows nothing of what they mean.

use crate::fault::Fault;

/// The first bytes of a file.
pub const MAGIC: &[u8] = b"\x93NUMPY";
/// The most sides that are read.
const MAX_SIDES: usize = 8;

fn bad(message: impl Into<String>, help: &str) -> Fault {
    Fault::new(message, help)
}

/// What stands after a key of the head.
fn value_of<'a>(head: &'a str, key: &str) -> Option<&'a str> {
    let (_, rest) = head.split_once(&format!("'{key}'"))?;
    Some(rest.trim_start().strip_prefix(':')?.trim_start())
}

/// Returns the shape and the numbers of an array.
///
/// # Errors
///
/// If the head is damaged, the numbers are no little-endian floats of 4 or 8 bytes in C order, or there are too few or too
/// many of them for the shape.
pub fn read(bytes: &[u8]) -> Result<(Vec<usize>, Vec<f64>), Fault> {
    const SAVE: &str = "save it by numpy.save, as numpy.ascontiguousarray(a, dtype='<f4')";
    let damaged = || bad("the head of the array is damaged", SAVE);
    let version = *bytes.get(MAGIC.len()).ok_or_else(damaged)?;
    let (length, start) = match (version, bytes.get(8..10), bytes.get(8..12)) {
        (1, Some(&[a, b]), _) => (usize::from(u16::from_le_bytes([a, b])), 10),
        (2 | 3, _, Some(&[a, b, c, d])) => (u32::from_le_bytes([a, b, c, d]) as usize, 12),
        _ => return Err(damaged()),
    };
    let end = start + length;
    let head = bytes.get(start..end).and_then(|head| std::str::from_utf8(head).ok()).ok_or_else(damaged)?;
    let kind = value_of(head, "descr").and_then(|rest| rest.split('\'').nth(1)).ok_or_else(damaged)?;
    let size = match kind {
        "<f4" => 4,
        "<f8" => 8,
        other => return Err(bad(format!("its numbers are of the type `{other}`, not <f4 or <f8"), SAVE)),
    };
    if !value_of(head, "fortran_order").is_some_and(|rest| rest.starts_with("False")) {
        return Err(bad("its first index is the fastest", SAVE));
    }
    let sides = value_of(head, "shape").and_then(|rest| rest.strip_prefix('(')?.split(')').next());
    let sides = sides.ok_or_else(damaged)?.split(',').map(str::trim).filter(|side| !side.is_empty());
    let shape = sides.map(str::parse).collect::<Result<Vec<usize>, _>>().map_err(|_| damaged())?;
    let count = shape.iter().try_fold(1usize, |product, &side| product.checked_mul(side));
    let wanted = count.and_then(|count| count.checked_mul(size)).filter(|_| shape.len() <= MAX_SIDES);
    let numbers = &bytes[end..];
    if wanted != Some(numbers.len()) {
        let message = format!("it holds {} bytes of numbers, which the shape {shape:?} does not take", numbers.len());
        return Err(bad(message, "save the array again"));
    }
    let values = match size {
        4 => numbers.as_chunks::<4>().0.iter().map(|bytes| f64::from(f32::from_le_bytes(*bytes))).collect(),
        _ => numbers.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect(),
    };
    Ok((shape, values))
}
