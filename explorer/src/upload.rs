//! Maps that are dropped on the page: what its request holds, and where what was made of it is kept. A body is a head of one
//! line a file, its length in bytes and its name; an empty line; and the files, one after another.

use crate::lighting::{self, Asset};
use crate::own;
use serde_json::Value;
use std::sync::{Mutex, PoisonError, RwLock};
use zonal_codegen::fault::Fault;
use zonal_codegen::reflectance::brdf::Brdf;

/// Where maps are sent to.
pub const PATH: &str = "map";
/// The largest body that is read, in bytes.
pub const MAX_BODY: usize = 1 << 28;
/// The longest head of a body, in bytes.
const MAX_HEAD: usize = 1 << 12;
/// How many dropped maps are kept; the oldest goes first.
const KEPT: usize = 8;

/// The maps that were dropped so far.
pub struct Uploads {
    brdfs: Vec<Brdf>,
    /// How many there were; held while one is read, so that there is memory for it.
    count: Mutex<usize>,
    kept: RwLock<Vec<Asset>>,
}

impl Uploads {
    /// None yet; `brdfs` are those of the page.
    pub fn new(brdfs: Vec<Brdf>) -> Self {
        Self { brdfs, count: Mutex::new(0), kept: RwLock::default() }
    }

    /// Reads a map, keeps its file, and returns its row of the page's index.
    ///
    /// # Errors
    ///
    /// If it is no map.
    pub fn add(&self, body: &[u8]) -> Result<Value, Fault> {
        let files = files(body)?;
        // What a panic would leave behind is only a number.
        let mut count = self.count.lock().unwrap_or_else(PoisonError::into_inner);
        let lit = own::dropped(*count + 1, &files)?;
        let (row, asset) = lighting::prepared(&lit, &self.brdfs);
        *count += 1;
        let mut kept = self.kept.write().unwrap_or_else(PoisonError::into_inner);
        if kept.len() == KEPT {
            kept.remove(0);
        }
        kept.push(asset);
        Ok(row)
    }

    /// The bytes of a file that was made of a dropped map.
    pub fn get(&self, path: &str) -> Option<Vec<u8>> {
        let kept = self.kept.read().unwrap_or_else(PoisonError::into_inner);
        kept.iter().find(|(known, _)| known == path).map(|(_, bytes)| bytes.clone())
    }
}

/// The files in a body.
fn files(body: &[u8]) -> Result<Vec<(String, Vec<u8>)>, Fault> {
    let wrong = |what: &str| Fault::new(format!("the request is none of this page: {what}"), "load the page again");
    let end =
        body.windows(2).take(MAX_HEAD).position(|window| window == b"\n\n").ok_or_else(|| wrong("it has no head"))?;
    let head = std::str::from_utf8(&body[..end]).map_err(|_| wrong("its head is no text"))?;
    let mut rest = &body[end + 2..];
    let mut files = Vec::new();
    for line in head.split('\n') {
        let (length, name) = line.split_once(' ').ok_or_else(|| wrong("a line of its head names no file"))?;
        let length: usize = length.parse().map_err(|_| wrong("a line of its head has no length"))?;
        let (bytes, others) = rest.split_at_checked(length).ok_or_else(|| wrong("it ends too early"))?;
        rest = others;
        files.push((own::name_of(name), bytes.to_vec()));
    }
    match rest.is_empty() {
        true => Ok(files),
        false => Err(wrong("it holds more than its head says")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_are_files_or_refused() {
        let good = files(b"3 a/b.hdr\n2 c.hdr\n\nabcde").expect("two files");
        assert_eq!(good, [("b.hdr".to_owned(), b"abc".to_vec()), ("c.hdr".to_owned(), b"de".to_vec())]);
        for (body, what) in [
            (&b""[..], "it has no head"),
            (b"3 a", "it has no head"),
            (b"x a\n\nabc", "has no length"),
            (b"-1 a\n\nabc", "has no length"),
            (b"3\n\nabc", "names no file"),
            (b"4 a\n\nabc", "ends too early"),
            (b"2 a\n\nabc", "more than its head says"),
            (b"99999999999999999999 a\n\nabc", "has no length"),
            (b"3 \xff\n\nabc", "is no text"),
        ] {
            let told = files(body).expect_err("it is refused").to_string();
            assert!(told.contains(what), "{told}");
        }
    }

    #[test]
    fn dropped_maps_are_kept_until_others_come() {
        let uploads = Uploads::new(vec![Brdf::Lambert]);
        let hdr = [&b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"[..], &[128, 64, 32, 129].repeat(2)].concat();
        let body = [format!("{} sky.hdr\n\n", hdr.len()).as_bytes(), &hdr].concat();
        for number in 1..=KEPT + 1 {
            let row = uploads.add(&body).expect("a map");
            assert_eq!(row["id"], format!("own-dropped-{number}"));
            assert!(row["told"].as_str().is_some_and(|told| told.contains("Radiance HDR")), "{row}");
        }
        assert!(uploads.get("data/light-own-dropped-1.bin").is_none());
        assert!(uploads.get("data/light-own-dropped-2.bin").is_some_and(|bytes| bytes.len() > 1200));
        let told = uploads.add(b"3 a.txt\n\nabc").expect_err("no map").to_string();
        assert!(told.contains("a.txt: holds unknown data"), "{told}");
        let two = uploads.add(b"1 a\n1 b\n\nab").expect_err("no cube").to_string();
        assert!(two.contains("hold no face of a cube by their names"), "{two}");
    }
}
