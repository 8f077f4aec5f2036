#![allow(clippy::all, clippy::pedantic, clippy::print_stdout, clippy::unwrap_used)]
//! t
use dem_io::surface::*;
fn main() {
    for f in std::env::args().skip(1) {
        let bytes = std::fs::read(&f).unwrap();
        for fill_holes in [true] {
        let t = std::time::Instant::now();
        let r = surface_from_stl(&bytes, f.rsplit('/').next().unwrap(), ReadSettings { unit_m: 1.0, scale: 1.0, fill_holes });
        let e = t.elapsed();
        match r {
            Ok(s) => println!("{} V={:.6} shells={:?} {e:?} {:?} {:?}\n", s.source, s.volume_m3(), s.shells.iter().take(4).collect::<Vec<_>>(), s.repairs, s.warnings),
            Err(d) => println!("ERR {e:?} {d}\n"),
        }
        }
    }
}
