//! Bulk behaviour of scenes that a user runs, against laws that others have measured.

use super::{Bench, scene_of_data, table};

/// Slope of a straight line through the values of a column of `series.csv` between two times.
fn slope(bench: &Bench, column: &str, [from, to]: [f64; 2]) -> f64 {
    let (columns, rows) = table(&bench.path("out/series.csv"));
    let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let (time, value) = (at("time_s"), at(column));
    let points: Vec<[f64; 2]> = (rows.iter())
        .map(|row| [time, value].map(|k| row[k].parse().unwrap()))
        .filter(|[t, _]: &[f64; 2]| (from..to).contains(t))
        .collect();
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
    let squares: f64 = points.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
    let products = points.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1]));
    products.sum::<f64>() / squares
}

#[test]
fn beads_leave_a_silo_as_beverloo_says() {
    // W = 0.58 rho sqrt(g) (D - k d)^(5/2) with k = 1.4 for spheres (Beverloo et al. 1961), for two
    // holes; the constants of the law are known to a tenth.
    for hole_m in [0.018, 0.022] {
        let bench = Bench::new();
        let scale = format!("walls.floor.scale={}", hole_m * 100.0);
        let scene = scene_of_data("silo.toml");
        let settings = [
            scale.as_str(),
            "inlets.fill.count=1200",
            "walls.slide.table=[[\"0.3 s\", 0], [\"0.35 s\", 1]]",
            "run.end_time=\"0.75 s\"",
        ];
        let mut options = vec!["--quiet", "--output", "out"];
        options.extend(settings.iter().flat_map(|setting| ["--set", setting]));
        bench.good(&scene, &options);
        let found = -slope(&bench, "mass_inside_kg", [0.45, 0.75]);
        let density = 1550.0;
        let wanted = 0.58 * density * 9.81_f64.sqrt() * (hole_m - 1.4 * 0.004_f64).powf(2.5);
        assert!((found / wanted - 1.0).abs() < 0.12, "{found} {wanted}");
    }
}
