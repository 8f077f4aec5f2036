use dem_run::shape::outer_layer::outer_layer_to;
fn main() {
    let path = std::env::args().nth(1).unwrap();
    let body = dem_io::body::read_body(std::path::Path::new(&path)).unwrap();
    let (c, r) = (body.positions, body.radii);
    let least = r.iter().copied().fold(f64::INFINITY, f64::min);
    println!("{} spheres, smallest {least}", r.len());
    for (behind, levels) in [
        (0.0, 1),
        (0.73205, 1),
        (0.73205, 2),
        (0.73205, 4),
        (0.73205, 8),
        (0.41421, 4),
    ] {
        for share in [0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5] {
            let n = outer_layer_to(&c, &r, 0.05, share * least, behind, levels).len();
            print!("{behind} {levels} {share}: {n}   ");
        }
        println!();
    }
}
