//! The command `zonal`.
fn main() {
    let start = std::time::Instant::now();
    let files = zonal_codegen::catalog::files().unwrap();
    eprintln!("{} files in {:?}, {} bytes", files.len(), start.elapsed(), files.iter().map(|f| f.text.len()).sum::<usize>());
    let folder = std::path::Path::new("generated");
    zonal_codegen::files::write(folder, &files).unwrap();
    zonal_codegen::files::remove_orphans(folder, &files).unwrap();
}
